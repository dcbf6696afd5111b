//! The browser page: a compiler for WebAssembly, the module, its script, and tests in Node and in Chromium.

mod build;
mod folders;
mod server;
mod tests;
mod toolchain;

use folders::site;

/// Actions beside the build of the page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    pub setup: bool,
    pub test: bool,
    pub pictures: bool,
    pub serve: bool,
}

impl Wish {
    /// The wish of the words behind `web`; `None` for an unknown word.
    pub fn parse(words: &[&str]) -> Option<Self> {
        let mut wish = Self::default();
        for word in words {
            match *word {
                "--setup" => wish.setup = true,
                "--test" => wish.test = true,
                "--pictures" => wish.pictures = true,
                "--serve" => wish.serve = true,
                _ => return None,
            }
        }
        Some(wish)
    }
}

/// Builds the page into out/web; draws its pictures, tests and serves it where that is wished for.
pub fn web(wish: Wish) -> bool {
    let built = toolchain::compiler(wish.setup).and_then(|compiler| build::page(&compiler));
    if let Err(error) = built {
        println!("the page is not built: {error:#}");
        return false;
    }
    let drawn = !wish.pictures || tests::pictures(wish.setup);
    let passed = drawn && (!wish.test || tests::test(wish.setup));
    if wish.serve
        && let Err(error) = server::serve_until_stopped(&site())
    {
        println!("the page is not served: {error:#}");
        return false;
    }
    passed
}

/// Builds and tests the page, with what is missing installed.
pub fn long() -> bool {
    web(Wish { setup: true, test: true, ..Wish::default() })
}

#[cfg(test)]
mod unit_tests {
    use super::*;

    #[test]
    fn words_are_wishes_in_any_order_and_others_are_refused() {
        assert_eq!(Wish::parse(&[]), Some(Wish::default()));
        let all = Wish { setup: true, test: true, pictures: true, serve: true };
        assert_eq!(Wish::parse(&["--serve", "--test", "--pictures", "--setup"]), Some(all));
        assert_eq!(Wish::parse(&["--tests"]), None);
    }
}
