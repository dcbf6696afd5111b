//! Golden pictures, compared as a person would see them \[Andersson2020\].

use std::path::PathBuf;

use strandline_render::Picture;

/// Compares a picture with the golden one of that name; with STRANDLINE_BLESS=1 in the environment it
/// becomes the golden one.
///
/// `mean` and `p99` bound the mean error and the error that one pixel of a hundred exceeds, both 0 to 1.
///
/// # Panics
/// The pictures differ by more, or there is no golden one.
pub fn assert_flip(picture: &Picture, name: &str, mean: f32, p99: f32) {
    if std::env::var_os("STRANDLINE_BLESS").is_some_and(|bless| bless == "1") {
        picture.save(path(name)).unwrap();
        return;
    }
    if let Err(message) = compare(picture, &golden(name), mean, p99) {
        let drawn = std::env::temp_dir().join(format!("{name}.png"));
        picture.save(&drawn).unwrap();
        panic!("{name}: {message}; drawn: {}", drawn.display());
    }
}

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("pictures/golden").join(format!("{name}.png"))
}

/// The golden picture of a name.
///
/// # Panics
/// There is none.
pub fn golden(name: &str) -> Picture {
    let path = path(name);
    let golden = match image::open(&path) {
        Ok(golden) => golden.into_rgb8(),
        Err(error) => {
            panic!("no golden picture ({error}): draw it with STRANDLINE_BLESS=1: {}", path.display())
        }
    };
    Picture { width: golden.width(), height: golden.height(), pixels: golden.into_raw(), alpha: None }
}

/// Compares two pictures; the message says what exceeds its bound.
///
/// # Errors
/// They differ by more.
pub fn compare(picture: &Picture, golden: &Picture, mean: f32, p99: f32) -> Result<(), String> {
    if (picture.width, picture.height) != (golden.width, golden.height) {
        return Err(format!(
            "{} x {} pixels, expected {} x {}",
            picture.width, picture.height, golden.width, golden.height
        ));
    }
    let image =
        |picture: &Picture| nv_flip::FlipImageRgb8::with_data(picture.width, picture.height, &picture.pixels);
    let errors = nv_flip::flip(image(golden), image(picture), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    let mut pool = nv_flip::FlipPool::from_image(&errors);
    let found = (pool.mean(), pool.get_percentile(0.99, false));
    if found.0 <= mean && found.1 <= p99 {
        Ok(())
    } else {
        Err(format!("mean error {}, at most {mean}; of one in a hundred {}, at most {p99}", found.0, found.1))
    }
}

#[test]
fn a_shifted_picture_is_noticed_and_an_equal_one_is_not() {
    let stripes = |shift: u32| {
        let pixels = (0..64 * 64)
            .flat_map(|pixel| if (pixel % 64 + shift) % 4 < 2 { [200, 150, 90] } else { [40, 30, 20] })
            .collect();
        Picture { width: 64, height: 64, pixels, alpha: None }
    };
    compare(&stripes(0), &stripes(0), 0.0, 0.0).unwrap();
    assert!(compare(&stripes(1), &stripes(0), 0.05, 1.0).is_err());
    assert!(compare(&stripes(1), &stripes(0), 1.0, 0.05).is_err());
}

#[test]
fn a_picture_of_another_size_is_noticed() {
    let blank = |size: u32| Picture {
        width: size,
        height: size,
        pixels: vec![0; (size * size * 3) as usize],
        alpha: None,
    };
    assert!(compare(&blank(8), &blank(9), 1.0, 1.0).unwrap_err().contains("8 x 8"));
}
