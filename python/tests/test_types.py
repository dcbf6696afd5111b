"""Types and docstrings: those of the settings table, and the stubs of the extension."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import strandline
from strandline import _native

HERE = Path(__file__).parent.parent


def test_sections_are_written_from_the_table():
    spec = importlib.util.spec_from_file_location("write_sections", HERE / "write_sections.py")
    writer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(writer)
    page = writer.page(_native.settings())
    assert (HERE / "strandline" / "sections.py").read_text(encoding="utf-8") == page, "run python -P python/write_sections.py"


def test_stubs_are_those_of_the_extension(tmp_path):
    words = [sys.executable, "-m", "mypy.stubtest", "strandline._native", "--ignore-missing-stub"]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-2000:]


def test_everything_public_has_a_docstring():
    for name in strandline.__all__:
        thing = getattr(strandline, name)
        assert thing.__doc__, name
        for own, member in vars(thing).items() if isinstance(thing, type) else ():
            if not own.startswith("_") and (callable(member) or isinstance(member, property)):
                assert getattr(member, "__doc__", None) or isinstance(member, classmethod | staticmethod), f"{name}.{own}"
