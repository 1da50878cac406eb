//! A virtual screen (Xvfb) and a hand on its mouse and keyboard (XTEST).

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{self, ConnectionExt as _};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// An X server of its own, ended when dropped.
pub struct Screen {
    server: Child,
    /// What DISPLAY has to be.
    pub display: String,
    connection: RustConnection,
    root: xproto::Window,
}

/// How long the mouse rests between two steps, so that every step is a frame of its own.
const STEP: Duration = Duration::from_millis(15);
/// How long a pressed button stays down before and after a drag: a hand is never faster, and a loaded machine may need
/// it.
const HOLD: Duration = Duration::from_millis(300);

impl Screen {
    /// Starts a server on a free display.
    ///
    /// # Panics
    /// If Xvfb is missing (setup.sh installs it) or does not answer.
    pub fn start(width: u32, height: u32) -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &format!("{width}x{height}x24"), "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb, which setup.sh installs");
        let mut number = String::new();
        let stdout = server.stdout.take().expect("the server's output");
        BufReader::new(stdout).read_line(&mut number).expect("a display number");
        let display = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&display)).expect("the new display");
        let root = connection.setup().roots[screen].root;
        Screen { server, display, connection, root }
    }

    /// Sets the server's resources, as `xrdb` does.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn set_resources(&self, resources: &str) {
        let (name, kind) = (xproto::AtomEnum::RESOURCE_MANAGER, xproto::AtomEnum::STRING);
        let mode = xproto::PropMode::REPLACE;
        self.connection.change_property8(mode, self.root, name, kind, resources.as_bytes()).expect("the property");
        self.connection.sync().expect("the server");
    }

    /// Lets a window see that there are other resources, as one does after a change of screens: winit looks for that at its
    /// own window too.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn tell_of_resources(&self, window: xproto::Window) {
        let (name, kind) = (xproto::AtomEnum::RESOURCE_MANAGER, xproto::AtomEnum::STRING);
        self.connection.change_property8(xproto::PropMode::REPLACE, window, name, kind, b"").expect("the property");
        self.connection.sync().expect("the server");
    }

    /// Moves the mouse.
    pub fn move_to(&self, x: f32, y: f32) {
        self.fake(xproto::MOTION_NOTIFY_EVENT, 0, x, y);
    }

    /// Clicks with the left button.
    pub fn click(&self, at: [f32; 2]) {
        self.move_to(at[0], at[1]);
        self.fake(xproto::BUTTON_PRESS_EVENT, 1, at[0], at[1]);
        self.fake(xproto::BUTTON_RELEASE_EVENT, 1, at[0], at[1]);
    }

    /// Drags with the left button, in a few steps.
    pub fn drag(&self, from: [f32; 2], to: [f32; 2]) {
        self.move_to(from[0], from[1]);
        self.fake(xproto::BUTTON_PRESS_EVENT, 1, from[0], from[1]);
        std::thread::sleep(HOLD);
        for step in 1..=10 {
            let share = step as f32 / 10.0;
            self.move_to(from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]));
        }
        std::thread::sleep(HOLD);
        self.fake(xproto::BUTTON_RELEASE_EVENT, 1, to[0], to[1]);
    }

    /// Drags with the left button to and fro between two points for so long, without a rest.
    pub fn drag_to_and_fro(&self, from: [f32; 2], to: [f32; 2], lasting: Duration) {
        self.move_to(from[0], from[1]);
        self.fake(xproto::BUTTON_PRESS_EVENT, 1, from[0], from[1]);
        let start = Instant::now();
        for step in (0..40).chain((1..=40).rev()).cycle() {
            let share = step as f32 / 40.0;
            let (x, y) = (from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]));
            self.move_to(x, y);
            if start.elapsed() >= lasting {
                return self.fake(xproto::BUTTON_RELEASE_EVENT, 1, x, y);
            }
        }
    }

    /// Turns the wheel by one notch, away from the user.
    pub fn wheel_up(&self, at: [f32; 2]) {
        self.wheel(4, at);
    }

    /// Turns the wheel by one notch, towards the user.
    pub fn wheel_down(&self, at: [f32; 2]) {
        self.wheel(5, at);
    }

    fn wheel(&self, button: u8, at: [f32; 2]) {
        self.move_to(at[0], at[1]);
        self.fake(xproto::BUTTON_PRESS_EVENT, button, at[0], at[1]);
        self.fake(xproto::BUTTON_RELEASE_EVENT, button, at[0], at[1]);
    }

    /// Types the key of a Latin letter or digit, with Control held if asked.
    pub fn key(&self, character: char, control: bool) {
        let hold = control.then_some(Screen::CONTROL);
        self.chord(&hold.into_iter().chain([u32::from(character)]).collect::<Vec<_>>());
    }

    /// The keysym of the Enter key.
    pub const ENTER: u32 = 0xff0d;
    /// The keysym of the Tab key.
    pub const TAB: u32 = 0xff09;
    /// The keysym of the Escape key.
    pub const ESCAPE: u32 = 0xff1b;
    /// The keysym of the right arrow key.
    pub const RIGHT: u32 = 0xff53;
    /// Keysym of the arrow to the left.
    pub const LEFT: u32 = 0xff51;
    /// The keysym of the left Control key.
    pub const CONTROL: u32 = 0xffe3;
    /// The keysym of the left Shift key.
    pub const SHIFT: u32 = 0xffe1;

    /// Presses and releases the key of a keysym.
    pub fn press(&self, keysym: u32) {
        self.chord(&[keysym]);
    }

    /// Presses keys in this order and releases them in the other one.
    pub fn chord(&self, keysyms: &[u32]) {
        let codes: Vec<u8> = keysyms.iter().map(|&keysym| self.keycode(keysym)).collect();
        codes.iter().for_each(|&code| self.fake(xproto::KEY_PRESS_EVENT, code, 0.0, 0.0));
        codes.iter().rev().for_each(|&code| self.fake(xproto::KEY_RELEASE_EVENT, code, 0.0, 0.0));
    }

    /// Types a text of ASCII characters.
    pub fn type_text(&self, text: &str) {
        text.chars().for_each(|character| self.chord(&self.keys_of(u32::from(character))));
    }

    /// The keys for a keysym: with Shift where it is on a key's upper half.
    fn keys_of(&self, keysym: u32) -> Vec<u32> {
        let upper = "~!@#$%^&*()_+{}|:\"<>?".contains(char::from_u32(keysym).unwrap_or(' '))
            || (u32::from('A')..=u32::from('Z')).contains(&keysym);
        if upper { vec![Screen::SHIFT, keysym] } else { vec![keysym] }
    }

    /// Gives the keyboard to the window of that program, by the end of its title, and returns it.
    ///
    /// # Panics
    /// If there is none.
    pub fn focus(&self, program: &str) -> xproto::Window {
        let window = self.find(program).expect("the window");
        self.connection.set_input_focus(xproto::InputFocus::PARENT, window, x11rb::CURRENT_TIME).expect("focus");
        self.connection.sync().expect("the server");
        window
    }

    /// Asks the window to close, as a window manager's button does.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn close(&self, window: xproto::Window) {
        let atom =
            |name: &[u8]| self.connection.intern_atom(false, name).expect("an atom").reply().expect("an atom").atom;
        let data = [atom(b"WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let event = xproto::ClientMessageEvent::new(32, window, atom(b"WM_PROTOCOLS"), data);
        self.connection.send_event(false, window, xproto::EventMask::NO_EVENT, event).expect("the message");
        self.connection.sync().expect("the server");
    }

    /// Sets the size of a window.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn resize(&self, window: xproto::Window, width: u32, height: u32) {
        let size = xproto::ConfigureWindowAux::new().width(width).height(height);
        self.connection.configure_window(window, &size).expect("the request");
        self.connection.sync().expect("the server");
    }

    /// Hides a window as minimising does, or shows it again.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn show(&self, window: xproto::Window, shown: bool) {
        let connection = &self.connection;
        let asked = if shown { connection.map_window(window) } else { connection.unmap_window(window) };
        asked.expect("the request");
        self.connection.sync().expect("the server");
    }

    /// Colours of a rectangle of the screen, RGB, rows from the top.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn pixels(&self, x: u32, y: u32, width: u32, height: u32) -> Vec<[u8; 3]> {
        let plane = xproto::ImageFormat::Z_PIXMAP;
        let request =
            self.connection.get_image(plane, self.root, x as i16, y as i16, width as u16, height as u16, u32::MAX);
        let image = request.expect("the request").reply().expect("the picture");
        image.data.chunks_exact(4).map(|p| [p[2], p[1], p[0]]).collect()
    }

    /// What the clipboard holds as `target`, "UTF8_STRING" or a MIME type; empty if it holds no such thing.
    ///
    /// # Panics
    /// If its owner does not answer within some seconds.
    pub fn clipboard(&self, target: &str) -> Vec<u8> {
        let connection = &self.connection;
        let atom = |name: &str| {
            connection.intern_atom(false, name.as_bytes()).expect("an atom").reply().expect("an atom").atom
        };
        let window = connection.generate_id().expect("an id");
        let (class, aux) = (xproto::WindowClass::INPUT_ONLY, xproto::CreateWindowAux::new());
        connection.create_window(0, window, self.root, 0, 0, 1, 1, 0, class, 0, &aux).expect("a window");
        let property = atom("VISAVIS_TEST");
        let now = x11rb::CURRENT_TIME;
        connection.convert_selection(window, atom("CLIPBOARD"), atom(target), property, now).expect("the request");
        connection.sync().expect("the server");
        for _ in 0..300 {
            while let Some(event) = connection.poll_for_event().expect("an event") {
                let x11rb::protocol::Event::SelectionNotify(answer) = event else { continue };
                if answer.property == 0 {
                    return Vec::new();
                }
                let all = u32::MAX / 4;
                let read = connection.get_property(true, window, property, xproto::AtomEnum::ANY, 0, all);
                return read.expect("the request").reply().expect("the clipboard").value;
            }
            std::thread::sleep(STEP);
        }
        panic!("the clipboard's owner does not answer");
    }

    fn fake(&self, event: u8, detail: u8, x: f32, y: f32) {
        let (x, y) = (x.round() as i16, y.round() as i16);
        self.connection.xtest_fake_input(event, detail, 0, self.root, x, y, 0).expect("a fake event");
        self.connection.sync().expect("the server");
        std::thread::sleep(STEP);
    }

    fn keycode(&self, keysym: u32) -> u8 {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let request = self.connection.get_keyboard_mapping(first, last - first + 1);
        let map = request.expect("the request").reply().expect("the keyboard");
        let per_code = usize::from(map.keysyms_per_keycode);
        let place = map.keysyms.iter().position(|&k| k == keysym).expect("a key for the character");
        first + (place / per_code) as u8
    }

    /// The title of a window.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn title(&self, window: xproto::Window) -> String {
        let (name, kind) = (xproto::AtomEnum::WM_NAME, xproto::AtomEnum::ANY);
        let request = self.connection.get_property(false, window, name, kind, 0, 256).expect("the request");
        String::from_utf8_lossy(&request.reply().expect("the title").value).into_owned()
    }

    fn find(&self, program: &str) -> Option<xproto::Window> {
        let tree = self.connection.query_tree(self.root).ok()?.reply().ok()?;
        tree.children.into_iter().find(|&window| {
            let name = xproto::AtomEnum::WM_NAME;
            let request = self.connection.get_property(false, window, name, xproto::AtomEnum::ANY, 0, 256);
            request.ok().and_then(|r| r.reply().ok()).is_some_and(|r| r.value.ends_with(program.as_bytes()))
        })
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // it may have ended already
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
