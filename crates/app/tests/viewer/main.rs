//! The viewer without a window: real scenes, settings, workers and pictures, driven through egui_kittest.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

mod camera;
mod cases;
mod closer;
mod comparison;
mod denoising;
mod device;
mod edits;
mod effects;
mod export;
mod external;
mod files;
mod labels;
mod ladder;
mod layout;
mod objects;
mod plots;
mod probe;
mod reports;
mod scenes;
mod sessions;
mod settings;
mod sweep;

use egui::accesskit::Role;
use egui::{ColorImage, Key, Modifiers, Pos2, TextureFilter, TextureHandle, TextureOptions, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use gpu::Gpu;
use reference::Store;
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};
use technique::{Adapters, DeviceChoice};
use visavis::engine::ask::Engine;
use visavis::engine::capture::Capture;
use visavis::model::{ComparisonSettings, Destination, Model, Theme};
use visavis::ui::{UiCommand, Workspaces};
use visavis::viewer::{Place, TextureStore, Viewer};
use visavis_tests::{Frame, TestFolder};

/// A viewer and who uses it.
pub struct User {
    harness: Harness<'static>,
    viewer: Rc<RefCell<Viewer>>,
    folder: TestFolder,
    uploads: Rc<RefCell<Vec<Upload>>>,
    /// One at a time: each has the machine to itself, as a user has.
    _alone: MutexGuard<'static, ()>,
    gpu: Gpu,
}

/// A file as a window hands it on.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|why| why.to_string())
    }
}

/// Pictures as egui keeps them by itself.
struct EguiTextures<'a> {
    context: egui::Context,
    kept: &'a mut HashMap<Place, TextureHandle>,
    uploads: &'a RefCell<Vec<Upload>>,
}

/// A picture that was put up: its place, its size, and what is between its pixels.
type Upload = (Place, (u32, u32), TextureFilter);

impl TextureStore for EguiTextures<'_> {
    fn upload(
        &mut self,
        place: Place,
        (width, height): (u32, u32),
        rgba: &[u8],
        filter: TextureFilter,
    ) -> egui::TextureId {
        let options = TextureOptions { magnification: filter, minification: filter, ..TextureOptions::NEAREST };
        let image = ColorImage::from_rgba_unmultiplied([width as usize, height as usize], rgba);
        let handle = self.context.load_texture(format!("{place:?}"), image, options);
        let id = handle.id();
        self.uploads.borrow_mut().push((place, (width, height), filter));
        self.kept.insert(place, handle);
        id
    }
}

impl User {
    /// Of a scene, at 1280 x 720.
    pub fn of(scene: &str) -> Self {
        Self::beside(scene, Vec2::new(1280.0, 720.0), 1.0, DeviceChoice::Auto)
    }

    /// Of a scene, who keeps references in this folder.
    pub fn who_keeps(scene: &str, store: &Path) -> Self {
        Self::with(scene, Vec2::new(1280.0, 720.0), 1.0, DeviceChoice::Auto, Some(store))
    }

    /// Of a scene, in a window of `size` points with `scale` pixels each, rays traced on `device`.
    pub fn beside(scene: &str, size: Vec2, scale: f32, device: DeviceChoice) -> Self {
        Self::with(scene, size, scale, device, None)
    }

    fn with(scene: &str, size: Vec2, scale: f32, device: DeviceChoice, store: Option<&Path>) -> Self {
        static ONE: Mutex<()> = Mutex::new(());
        let alone = ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let gpu = Gpu::headless().expect("a device that draws the fake");
        let adapters = Adapters::of(&Gpu::adapters());
        let opened = scene::builtin::named(scene).expect("a scene");
        let model = Model::new(opened, scene.into(), Theme::Dark).beside(adapters.clone(), device);
        let folder = TestFolder::new();
        let store = store.map_or_else(|| folder.file("store"), Path::to_owned);
        let open_store = Arc::new(move || Ok(Store::new(store.clone(), Store::MOST_BYTES)));
        let engine = Engine::start(&gpu, &adapters, open_store, Arc::new(|| {})).expect("threads");
        let viewer = Viewer::new(model, Workspaces::default(), engine, Instant::now());
        let viewer = Rc::new(RefCell::new(viewer));
        let uploads = Rc::new(RefCell::new(Vec::new()));
        let (shared, mut kept, put_up) = (viewer.clone(), HashMap::new(), uploads.clone());
        let app = move |ui: &mut egui::Ui| {
            let mut viewer = shared.borrow_mut();
            viewer.collect(&mut EguiTextures { context: ui.ctx().clone(), kept: &mut kept, uploads: &put_up });
            viewer.draw(ui);
            for command in viewer.take_commands() {
                let for_a_window = viewer.handle(command);
                assert!(for_a_window.is_none_or(|command| command == UiCommand::Quit), "there is no window");
            }
            viewer.ask();
            viewer.shown();
        };
        let harness = Harness::builder().with_size(size).with_pixels_per_point(scale).build_ui(app);
        User { harness, viewer, folder, uploads, _alone: alone, gpu }
    }

    /// Exports the picture as seen, of which no window has any pixels.
    pub fn export_as_seen(&mut self, file: &Path) -> Frame {
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let capture = Capture { gpu: self.gpu.clone(), texture, part: [0, 0, 4, 4] };
        self.viewer.borrow_mut().export_as_seen(capture, Destination::File(file.to_owned()));
        self.wait_for("the picture as seen", |_| file.is_file())
    }

    /// Changes what controls would change.
    pub fn change(&mut self, change: impl FnOnce(&mut Model)) {
        change(&mut self.viewer.borrow_mut().model);
    }

    /// What is compared with what.
    pub fn comparison(&self) -> ComparisonSettings {
        self.viewer.borrow().model.session.comparison.clone()
    }

    /// A file that no test has but this one.
    pub fn file(&self, name: &str) -> std::path::PathBuf {
        self.folder.file(name)
    }

    /// Lets a frame go by.
    pub fn frame(&mut self) -> Frame {
        self.harness.step();
        let context = &self.harness.ctx;
        Frame::of(&self.viewer.borrow().dump(context, context.pixels_per_point(), serde_json::Value::Null))
    }

    /// Lets frames go by until `holds` is true of one.
    pub fn wait_for(&mut self, what: &str, holds: impl Fn(&Frame) -> bool) -> Frame {
        let start = Instant::now();
        loop {
            let frame = self.frame();
            if holds(&frame) {
                return frame;
            }
            assert!(start.elapsed() < Duration::from_secs(120), "waited two minutes for: {what}; last seen: {frame:?}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Clicks the widget that screen readers call so.
    pub fn click(&mut self, name: &str) -> Frame {
        self.scroll_to(name);
        self.harness.get_by_label(name).click();
        self.harness.run_steps(3);
        self.frame()
    }

    /// Clicks one of several that are called so, counted from the top.
    pub fn click_nth(&mut self, name: &str, nth: usize) -> Frame {
        self.harness.get_all_by_label(name).nth(nth).expect("the widget").click();
        self.harness.run_steps(3);
        self.frame()
    }

    /// Scrolls until the widget is seen that screen readers call so.
    pub fn scroll_to(&mut self, name: &str) {
        self.harness.get_by_label(name).scroll_to_me();
        self.harness.run_steps(3);
    }

    /// Scrolls until the number is seen that screen readers call so.
    pub fn scroll_to_number(&mut self, name: &str) {
        self.harness.get_by_role_and_label(Role::SpinButton, name).scroll_to_me();
        self.harness.run_steps(3);
    }

    /// Types a number, and Enter.
    pub fn type_number(&mut self, name: &str, text: &str) -> Frame {
        self.scroll_to_number(name);
        self.harness.get_by_role_and_label(Role::SpinButton, name).click();
        self.harness.run_steps(2);
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.run_steps(1);
        self.harness.event(egui::Event::Text(text.into()));
        self.harness.run_steps(2);
        self.key(Key::Enter)
    }

    /// The same among the settings of a pane.
    pub fn click_in(&mut self, pane: &str, name: &str) -> Frame {
        // the button that folds them has the same name
        let title = format!("Settings of {pane}");
        let group = self.harness.get_by_role_and_label(Role::Group, &title);
        group.get_by_label(name).scroll_to_me();
        self.harness.run_steps(3);
        let group = self.harness.get_by_role_and_label(Role::Group, &title);
        group.get_by_label(name).click();
        self.harness.run_steps(3);
        self.frame()
    }

    /// Unfolds the rare settings of a pane.
    pub fn unfold_more(&mut self, pane: &str) -> Frame {
        let title = format!("Settings of {pane}");
        let group = self.harness.get_by_role_and_label(Role::Group, &title);
        group.get_by_label_contains("more settings").scroll_to_me();
        self.harness.run_steps(3);
        let group = self.harness.get_by_role_and_label(Role::Group, &title);
        group.get_by_label_contains("more settings").click();
        self.harness.run_steps(3);
        self.frame()
    }

    /// Sets a slider as a screen reader does.
    pub fn set_slider(&mut self, name: &str, value: f64) -> Frame {
        self.harness.get_by_role_and_label(Role::Slider, name).set_value_accesskit(value);
        self.harness.run_steps(2);
        self.frame()
    }

    /// Presses a key alone.
    pub fn key(&mut self, key: Key) -> Frame {
        self.key_with(key, Modifiers::NONE)
    }

    /// Presses a key with others.
    pub fn key_with(&mut self, key: Key, modifiers: Modifiers) -> Frame {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.step();
        self.frame()
    }

    /// Types into the field that screen readers call so, in the place of what is there.
    pub fn type_into(&mut self, name: &str, text: &str) -> Frame {
        let field = self.harness.get_by_label(name);
        field.focus();
        self.harness.step();
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.step();
        self.harness.get_by_label(name).type_text(text);
        self.harness.run_steps(2);
        self.frame()
    }

    /// Turns the wheel at a point, in pixels.
    pub fn wheel(&mut self, at: [f32; 2], modifiers: Modifiers) -> Frame {
        self.harness.hover_at(Pos2::from(at) / self.harness.ctx.pixels_per_point());
        self.harness.step();
        let delta = Vec2::new(0.0, 1.0);
        let (unit, phase) = (egui::MouseWheelUnit::Line, egui::TouchPhase::Move);
        let source = egui::MouseWheelSource::Wheel;
        self.harness.event(egui::Event::MouseWheel { unit, delta, phase, source, modifiers });
        self.harness.run_steps(3);
        self.frame()
    }

    /// Another size of the window, in points.
    pub fn resize(&mut self, size: Vec2) {
        self.harness.set_size(size);
        // widgets are where the last frame has put them
        self.harness.run_steps(2);
    }

    /// Holds a file over the window, or takes it away.
    pub fn hover_file(&mut self, file: Option<&Path>) -> Frame {
        let hovered = |path: &Path| egui::HoveredFile { path: Some(path.to_owned()), ..Default::default() };
        self.harness.input_mut().hovered_files = file.map(hovered).into_iter().collect();
        self.frame()
    }

    /// Lets a file fall onto the window.
    pub fn drop_file(&mut self, file: &Path) -> Frame {
        self.harness.input_mut().dropped_files.push(Arc::new(Dropped(file.to_owned())));
        self.frame()
    }

    /// The same scene from a file.
    pub fn open(&mut self, name: &str) -> Frame {
        self.harness.get_by_label_contains("Scene: ").click();
        self.harness.run_steps(3);
        self.type_into("A scene (.toml) or a model (.glb, .gltf, .ply, .obj):", name);
        self.key(Key::Enter)
    }
}

/// Both pictures are there at full resolution.
pub fn both_whole(frame: &Frame) -> bool {
    let whole = |pane: &str| frame.state(pane)["ready"] == true && frame.state(pane)["rough"] == false;
    whole("a") && whole("b")
}

/// The last message has these words.
pub fn says(frame: &Frame, words: &str) -> bool {
    frame.state("message").as_str().is_some_and(|message| message.contains(words))
}
