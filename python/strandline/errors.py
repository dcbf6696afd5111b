"""The one exception of the package."""


class Error(Exception):
    """Raised for everything that strandline refuses, with the text that the program prints.

    ``kind`` says what a caller may do about it: ``"value"``, ``"file"``, ``"busy"``, ``"too_large"``,
    ``"device_lost"``, ``"out_of_memory"``, ``"refused"``, ``"extra"`` (a package is missing) or ``"other"``.
    """

    kind: str

    def __init__(self, text: str, kind: str = "other") -> None:
        super().__init__(text)
        self.kind = kind

    def __reduce__(self) -> tuple[type["Error"], tuple[str, str]]:
        return type(self), (str(self), self.kind)


def missing(package: str, extra: str) -> Error:
    """The error of a package that an extra brings."""
    return Error(f"{package} is not installed, expected the extra: pip install 'strandline[{extra}]'", "extra")
