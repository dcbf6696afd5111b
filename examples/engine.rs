//! Hair in an engine: the engine owns window, device and loop; the hair is drawn into a texture of the engine, which the
//! engine puts on its screen. No call of the loop waits for the GPU. Pull the hair with the mouse.
//! `cargo run --release -p strandline-viewer --example engine`; a number behind it ends it after so many pictures.
#![allow(clippy::print_stdout)] // an example says what it does

use std::{error::Error, sync::Arc};

use strandline::{
    Change, FrameLoop, PictureSettings, Prepared, Ray, Scene, Style,
    device::{Gpu, wgpu},
};
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::{ElementState, MouseButton, WindowEvent},
    event_loop::{ActiveEventLoop, EventLoop},
    window::{Window, WindowId},
};

/// Format of the texture that the hair is drawn into.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Radius of the hand [m].
const HAND: f32 = 0.025;

/// Everything that an engine has: the hair is one guest of its device.
struct Engine {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    surface_settings: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    blitter: wgpu::util::TextureBlitter,
    target: wgpu::TextureView,
    hair: FrameLoop,
    mouse: glam::Vec2,
}

fn texture(device: &wgpu::Device, width: u32, height: u32) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the engine's texture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

impl Engine {
    fn open(window: Arc<Window>) -> Result<Self, Box<dyn Error>> {
        let PhysicalSize { width, height } = window.inner_size();
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(window.clone())?;
        let wanted = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&wanted))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let surface_settings = surface.get_default_config(&adapter, width, height).ok_or("no surface")?;
        surface.configure(&device, &surface_settings);

        // The device stays the engine's; the hair takes its part of it.
        let gpu = Gpu::from_parts(device.clone(), queue.clone());
        let mut scene = Scene::demo();
        scene.set_style(Style::Wavy);
        [scene.picture.width, scene.picture.height] = [width, height];
        let hair = FrameLoop::with_device(Prepared::new(&scene)?, &gpu)?;
        // From here on a call that would wait is an error.
        gpu.never_wait();
        let blitter = wgpu::util::TextureBlitter::new(&device, surface_settings.format);
        let target = texture(&device, width, height);
        let mouse = glam::Vec2::ZERO;
        Ok(Self { window, surface, surface_settings, device, queue, blitter, target, hair, mouse })
    }

    fn resize(&mut self, size: PhysicalSize<u32>) -> Result<(), Box<dyn Error>> {
        let [width, height] = [size.width, size.height].map(|side| side.max(16));
        let shown = self.hair.scene().picture;
        self.hair.change(Change::Picture(PictureSettings { width, height, ..shown }))?;
        self.target = texture(&self.device, width, height);
        (self.surface_settings.width, self.surface_settings.height) = (width, height);
        self.surface.configure(&self.device, &self.surface_settings);
        Ok(())
    }

    /// A frame of the engine's loop; true where the screen shows it.
    fn frame(&mut self) -> Result<bool, Box<dyn Error>> {
        self.hair.frame()?;
        self.hair.draw_to(&self.target, FORMAT)?;
        use wgpu::CurrentSurfaceTexture as Current;
        let screen = match self.surface.get_current_texture() {
            Current::Success(screen) | Current::Suboptimal(screen) => screen,
            Current::Outdated | Current::Lost => {
                self.surface.configure(&self.device, &self.surface_settings);
                return Ok(false);
            }
            _ => return Ok(false),
        };
        let view = screen.texture.create_view(&Default::default());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.blitter.copy(&self.device, &mut encoder, &self.target, &view);
        self.queue.submit([encoder.finish()]);
        self.queue.present(screen);
        Ok(true)
    }

    /// Line of sight through the mouse.
    fn ray(&self) -> Ray {
        let size = self.window.inner_size();
        let (width, height) = (size.width as f32, size.height as f32);
        let across =
            glam::Vec2::new(2.0 * self.mouse.x - width, height - 2.0 * self.mouse.y) / height.max(1.0);
        Ray::new(self.hair.camera(), across)
    }

    fn take(&mut self, event: WindowEvent) -> Result<(), Box<dyn Error>> {
        match event {
            WindowEvent::Resized(size) => self.resize(size)?,
            WindowEvent::CursorMoved { position, .. } => {
                self.mouse = glam::Vec2::new(position.x as f32, position.y as f32);
                self.hair.change(Change::Drag(self.ray()))?;
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => match state {
                ElementState::Pressed => self.hair.change(Change::Grab(self.ray(), HAND))?,
                ElementState::Released => self.hair.change(Change::Release)?,
            },
            _ => {}
        }
        Ok(())
    }
}

/// The engine once it has a window, its first error, and the pictures left to show; without a number it has no end.
struct Program {
    engine: Option<Engine>,
    failed: Option<Box<dyn Error>>,
    left: Option<u32>,
}

impl Program {
    fn act(&mut self, event_loop: &ActiveEventLoop, event: WindowEvent) -> Result<(), Box<dyn Error>> {
        let Some(engine) = &mut self.engine else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::RedrawRequested => {
                let is_shown = engine.frame()?;
                engine.window.request_redraw();
                if let Some(left) = self.left.as_mut().filter(|_| is_shown) {
                    *left = left.saturating_sub(1);
                }
                if self.left == Some(0) {
                    event_loop.exit();
                }
            }
            event => engine.take(event)?,
        }
        Ok(())
    }
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let wanted = Window::default_attributes()
            .with_title("An engine with hair")
            .with_inner_size(PhysicalSize::new(480, 600));
        let opened = event_loop.create_window(wanted).map_err(Into::into);
        match opened.and_then(|window| Engine::open(window.into())) {
            Ok(engine) => {
                engine.window.request_redraw();
                self.engine = Some(engine);
            }
            Err(error) => {
                self.failed = Some(error);
                event_loop.exit();
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Err(error) = self.act(event_loop, event) {
            self.failed = Some(error);
            event_loop.exit();
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let left = std::env::args().nth(1).map(|number| number.parse()).transpose()?;
    let mut program = Program { engine: None, failed: None, left };
    let events = match EventLoop::new() {
        Ok(events) => events,
        Err(error) => {
            println!("nothing is drawn without a display: {error}");
            return Ok(());
        }
    };
    events.run_app(&mut program)?;
    program.failed.map_or(Ok(()), Err)
}
