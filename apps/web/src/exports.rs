//! The page's class of its script.

#![allow(unsafe_code)] // written by wasm_bindgen

use glam::Vec2;
use wasm_bindgen::prelude::*;

#[cfg(feature = "gpu")]
use crate::device::Device;
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

    /// True while a device of the browser simulates and draws.
    pub fn is_on_device(&self) -> bool {
        self.page.gpu().is_some()
    }

    /// Goes on on the CPU with the hair as it is.
    pub fn to_processor(&mut self, reason: &str) -> Done {
        self.page.fall_back_after(reason).map_err(refused)
    }

    /// Strands where no setting tells.
    pub fn set_strands(&mut self, strands: u32) -> Done {
        self.page.set_strands(strands as usize).map_err(refused)
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

    /// False where no time has passed.
    pub fn frame(&mut self) -> Result<bool, JsError> {
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

    pub fn grab(&mut self, x: f32, y: f32, radius: f32) -> Done {
        self.page.grab(Vec2::new(x, y), radius).map_err(refused)
    }

    /// True where the hand holds hair; `undefined` while a device is asked.
    pub fn grabbed(&mut self) -> Result<Option<bool>, JsError> {
        self.page.grabbed().map_err(refused)
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

    /// Coordinates of all points of the guides \[m\], world space; `undefined` while a device is asked.
    pub fn points(&mut self) -> Result<Option<Vec<f32>>, JsError> {
        let points = self.page.points().map_err(refused)?;
        Ok(points.map(|points| points.into_iter().flat_map(|point| point.to_array()).collect()))
    }

    pub fn notes(&mut self) -> Vec<String> {
        self.page.take_notes()
    }
}

#[cfg(feature = "gpu")]
#[wasm_bindgen]
impl Engine {
    /// As the constructor, simulated and drawn on a device of the browser.
    pub fn on_device(
        device: &Device,
        keys: Vec<String>,
        values: Vec<String>,
        width: u32,
        height: u32,
    ) -> Result<Self, JsError> {
        let given = keys.into_iter().zip(values).collect();
        let page = Page::open_on(given, [width, height], device.gpu()).map_err(refused)?;
        Ok(Self { page, width: 0, height: 0 })
    }

    /// Draws into the canvas of the device; its size are `width` and `height` from then on. False where the device has
    /// failed.
    pub fn draw(&mut self, device: &Device) -> Result<bool, JsError> {
        [self.width, self.height] = self.page.size();
        let Some((target, format)) = device.target(self.page.size()) else {
            self.page.fall_back_after("the canvas gives no texture").map_err(refused)?;
            return Ok(false);
        };
        let view = target.texture.create_view(&Default::default());
        let drawn = self.page.draw_to(&view, format).map_err(refused);
        device.watch();
        drawn
    }
}
