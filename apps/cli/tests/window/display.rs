//! A display without a screen, and somebody at its mouse and keys.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConnectionExt, EventMask, ImageFormat, InputFocus, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Size of the screen and of the window on it \[pixel\].
pub const SIZE: [usize; 2] = [1280, 800];
/// The mouse rests as long as this around a click: a window that is drawn on two threads sees all that
/// happens in between as one.
const MOMENT: Duration = Duration::from_millis(400);
/// Time limit of every wait.
const PATIENCE: Duration = Duration::from_secs(60);

/// An X server that draws into memory.
pub struct Display {
    _turn: MutexGuard<'static, ()>,
    server: Child,
    name: String,
}

impl Display {
    /// Starts one; none where there is no Xvfb or nothing to draw with, unless a display is required.
    pub fn start() -> Option<Self> {
        strandline_checks::gpu()?;
        // One window at a time: pictures come as fast as they can.
        static TURN: Mutex<()> = Mutex::new(());
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let size = format!("{}x{}x24", SIZE[0], SIZE[1]);
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &size, "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match server {
            Ok(server) => server,
            Err(error) => {
                let required =
                    std::env::var_os("STRANDLINE_REQUIRE_DISPLAY").is_some_and(|value| value == "1");
                assert!(!required, "a display is required: Xvfb: {error}");
                println!("skipped: there is no Xvfb to open a window on");
                return None;
            }
        };
        // It tells its number once it is ready.
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Some(Self { _turn: turn, server, name: format!(":{}", number.trim()) })
    }

    /// The program on this display.
    pub fn program(&self, folder: &Path, arguments: &[&str]) -> Command {
        let mut program = Command::new(env!("CARGO_BIN_EXE_strandline"));
        program
            .args(arguments)
            .current_dir(folder)
            .env("DISPLAY", &self.name)
            .env_remove("WAYLAND_DISPLAY")
            // The window's stored state is this test's alone.
            .env("XDG_DATA_HOME", folder.join("data"));
        program
    }

    /// Opens the program's window and waits for it.
    pub fn open(&self, folder: &Path, arguments: &[&str]) -> Person {
        let program = self.program(folder, arguments).spawn().unwrap();
        let (connection, screen) = x11rb::connect(Some(&self.name)).unwrap();
        let root = connection.setup().roots[screen].root;
        let mut person = Person { connection, root, window: 0, program, begin: Instant::now() };
        person.window = person.wait("a window", Person::find_window);
        person
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Pixels of the display: rows of red, green and blue.
#[derive(Clone, PartialEq)]
pub struct Screen(Vec<[u8; 3]>);

impl Screen {
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.0[y * SIZE[0] + x]
    }

    /// Pixels of a box \[left, top, right, bottom\] that are of a kind.
    pub fn count(&self, [left, top, right, bottom]: [usize; 4], is: impl Fn([u8; 3]) -> bool) -> usize {
        (top..bottom).map(|y| (left..right).filter(|x| is(self.at(*x, y))).count()).sum()
    }

    /// Pixels of a box that differ from another screen's by more than a few steps.
    pub fn changed(&self, other: &Self, [left, top, right, bottom]: [usize; 4]) -> usize {
        let differ = |x: usize, y: usize| {
            let pairs = self.at(x, y).into_iter().zip(other.at(x, y));
            pairs.map(|(a, b)| a.abs_diff(b)).max() > Some(8)
        };
        (top..bottom).map(|y| (left..right).filter(|x| differ(*x, y)).count()).sum()
    }

    pub fn save(&self, path: &Path) {
        let pixels = self.0.concat();
        image::save_buffer(path, &pixels, SIZE[0] as u32, SIZE[1] as u32, image::ColorType::Rgb8).unwrap();
    }
}

/// Somebody who looks at the program's window, and has a mouse and keys.
pub struct Person {
    pub connection: RustConnection,
    pub root: Window,
    pub window: Window,
    program: Child,
    /// When the program was started.
    pub begin: Instant,
}

impl Person {
    /// Looks until something is there.
    pub fn wait<T>(&mut self, what: &str, mut look: impl FnMut(&mut Self) -> Option<T>) -> T {
        let begin = Instant::now();
        loop {
            if let Some(found) = look(self) {
                return found;
            }
            if let Ok(Some(status)) = self.program.try_wait() {
                panic!("the program ended before {what}: {status}");
            }
            if begin.elapsed() > PATIENCE {
                self.screen().save(&std::env::temp_dir().join("strandline-window.png"));
                panic!("never: {what}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits for a screen of a kind.
    pub fn see(&mut self, what: &str, is: impl Fn(&Screen) -> bool) -> Screen {
        self.wait(what, |person| Some(person.screen()).filter(&is))
    }

    fn find_window(&mut self) -> Option<Window> {
        let tree = self.connection.query_tree(self.root).unwrap().reply().unwrap();
        tree.children.into_iter().find(|window| {
            let name = self
                .connection
                .get_property(false, *window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64)
                .map(|cookie| cookie.reply());
            matches!(name, Ok(Ok(name)) if name.value == b"strandline")
        })
    }

    /// Gives the keys to the window, which a window manager would do; it has to be seen already.
    pub fn focus(&mut self) {
        let focused = self.connection.set_input_focus(InputFocus::PARENT, self.window, x11rb::CURRENT_TIME);
        focused.unwrap().check().unwrap();
    }

    /// Current pixels of the window.
    pub fn screen(&mut self) -> Screen {
        let [width, height] = SIZE.map(|side| side as u16);
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, u32::MAX)
            .unwrap()
            .reply()
            .unwrap();
        Screen(image.data.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect())
    }

    /// Sends an event to the X server: press of a key (2) or a button (4), its release (3, 5), or a move (6).
    pub fn fake(&mut self, kind: u8, detail: u8, [x, y]: [i16; 2]) {
        self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).unwrap();
        self.connection.flush().unwrap();
        // A person is not faster than this.
        std::thread::sleep(Duration::from_millis(30));
    }

    pub fn point(&mut self, place: [i16; 2]) {
        self.fake(6, 0, place);
    }

    pub fn press(&mut self, button: u8) {
        self.fake(4, button, [0; 2]);
        std::thread::sleep(MOMENT);
    }

    /// Lets go of a button; the mouse rests a moment before it does and after.
    pub fn release(&mut self, button: u8) {
        std::thread::sleep(MOMENT);
        self.fake(5, button, [0; 2]);
        std::thread::sleep(MOMENT);
    }

    /// Drags with the left button along places.
    pub fn drag(&mut self, places: &[[i16; 2]]) {
        self.point(places[0]);
        self.press(1);
        for pair in places.windows(2) {
            for step in 1..=8 {
                let at = |axis: usize| pair[0][axis] + (pair[1][axis] - pair[0][axis]) * step / 8;
                self.point([at(0), at(1)]);
            }
        }
        self.release(1);
    }

    fn code(&mut self, symbol: u32) -> u8 {
        let setup = self.connection.setup();
        let (least, most) = (setup.min_keycode, setup.max_keycode);
        let map = self.connection.get_keyboard_mapping(least, most - least + 1).unwrap().reply().unwrap();
        let each = usize::from(map.keysyms_per_keycode);
        let place = map.keysyms.chunks(each).position(|symbols| symbols[0] == symbol);
        least + place.expect("the keyboard has this key") as u8
    }

    /// Presses and releases a key, by its X symbol.
    pub fn key(&mut self, symbol: u32) {
        let code = self.code(symbol);
        self.fake(2, code, [0; 2]);
        self.fake(3, code, [0; 2]);
    }

    pub fn atom(&self, name: &str) -> u32 {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    pub fn tell(&self, kind: &str, data: [u32; 5]) {
        let event = ClientMessageEvent::new(32, self.window, self.atom(kind), data);
        self.connection.send_event(false, self.window, EventMask::NO_EVENT, event).unwrap();
        self.connection.flush().unwrap();
    }

    /// Closes the window as its button would; how the program ended.
    pub fn close(mut self) -> ExitStatus {
        self.tell("WM_PROTOCOLS", [self.atom("WM_DELETE_WINDOW"), 0, 0, 0, 0]);
        let begin = Instant::now();
        loop {
            if let Some(status) = self.program.try_wait().unwrap() {
                return status;
            }
            assert!(begin.elapsed() < PATIENCE, "the window does not close");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Person {
    /// True while the program runs.
    pub fn is_open(&mut self) -> bool {
        self.program.try_wait().unwrap().is_none()
    }

    /// Seconds that the program has computed until now, on all threads.
    pub fn cpu_seconds(&self) -> f64 {
        let text = std::fs::read_to_string(format!("/proc/{}/stat", self.program.id())).unwrap();
        let (_, fields) = text.rsplit_once(')').unwrap();
        let ticks = |field: usize| fields.split_whitespace().nth(field).unwrap().parse::<u64>().unwrap();
        // Fields 14 and 15 of proc_pid_stat(5), in ticks of 10 ms; what follows the name begins with field 3.
        (ticks(11) + ticks(12)) as f64 / 100.0
    }

    /// Memory of the program that is resident now \[MiB\].
    pub fn memory(&self) -> u64 {
        let text = std::fs::read_to_string(format!("/proc/{}/status", self.program.id())).unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
        line.split_whitespace().next().unwrap().parse::<u64>().unwrap() >> 10
    }
}

impl Drop for Person {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}
