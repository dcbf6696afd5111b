//! The page's class of its script.

#![allow(unsafe_code)] // written by wasm_bindgen

use glam::Vec2;
use wasm_bindgen::prelude::*;

use crate::{Page, bits};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = console, js_name = error)]
    fn console_error(text: &str);
}

/// Prints panics on the console of the browser, which else tells nothing of them.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| console_error(&panic.to_string())));
}

/// Bits of a scene on the CPU: see [`bits::line`].
#[wasm_bindgen]
pub fn bits_line(name: &str) -> Result<String, JsError> {
    bits::line(name).map_err(|error| JsError::new(&error.to_string()))
}

/// Names of the scenes whose bits are compared.
#[wasm_bindgen]
pub fn bits_names() -> Vec<String> {
    bits::NAMES.map(str::to_owned).to_vec()
}

/// Hair of a page, and its last picture.
#[wasm_bindgen]
pub struct Engine {
    page: Page,
    width: u32,
    height: u32,
}

type Done = Result<(), JsError>;

fn refused(message: String) -> JsError {
    JsError::new(&message)
}

#[wasm_bindgen]
impl Engine {
    #[wasm_bindgen(constructor)]
    pub fn new(keys: Vec<String>, values: Vec<String>, width: u32, height: u32) -> Result<Self, JsError> {
        let given = keys.into_iter().zip(values).collect();
        let page = Page::open(given, [width, height]).map_err(refused)?;
        Ok(Self { page, width: 0, height: 0 })
    }

    pub fn set(&mut self, key: &str, value: &str) -> Done {
        self.page.set(key, value).map_err(refused)
    }

    pub fn get(&self, key: &str) -> Result<String, JsError> {
        self.page.get(key).map_err(refused)
    }

    /// Keys and values in turn.
    pub fn given(&self) -> Vec<String> {
        self.page.given().iter().flat_map(|(key, value)| [key.clone(), value.clone()]).collect()
    }

    pub fn drop_file(&mut self, name: &str, bytes: &[u8]) -> Done {
        self.page.drop_file(name, bytes).map_err(refused)
    }

    pub fn resize(&mut self, width: u32, height: u32) -> Done {
        self.page.resize([width, height]).map_err(refused)
    }

    pub fn frame(&mut self) -> Done {
        self.page.frame().map_err(refused)
    }

    /// RGBA, rows from the top; its size are `width` and `height` from then on.
    pub fn picture(&mut self, coarseness: Option<u32>) -> Result<Vec<u8>, JsError> {
        let picture = self.page.picture(coarseness.map(|number| number as usize)).map_err(refused)?;
        (self.width, self.height) = (picture.width, picture.height);
        Ok(picture.interleaved())
    }

    #[wasm_bindgen(getter)]
    pub fn width(&self) -> u32 {
        self.width
    }

    #[wasm_bindgen(getter)]
    pub fn height(&self) -> u32 {
        self.height
    }

    pub fn grab(&mut self, x: f32, y: f32, radius: f32) -> Result<bool, JsError> {
        self.page.grab(Vec2::new(x, y), radius).map_err(refused)
    }

    pub fn drag(&mut self, x: f32, y: f32) -> Done {
        self.page.drag(Vec2::new(x, y)).map_err(refused)
    }

    pub fn release(&mut self) -> Done {
        self.page.release().map_err(refused)
    }

    pub fn reset(&mut self) -> Done {
        self.page.reset().map_err(refused)
    }

    pub fn strand_count(&self) -> u32 {
        self.page.strand_count() as u32
    }

    /// Coordinates of all points of the guides \[m\], world space.
    pub fn points(&mut self) -> Result<Vec<f32>, JsError> {
        let points = self.page.points().map_err(refused)?;
        Ok(points.into_iter().flat_map(|point| point.to_array()).collect())
    }

    pub fn notes(&mut self) -> Vec<String> {
        self.page.take_notes()
    }
}
