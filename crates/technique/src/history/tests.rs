use super::*;
use crate::{Adapters, Pacing, ProgressiveRenderer, Shot, Threads, TracedSettings, TruthSettings};
use film::Vec3;
use std::sync::Mutex;

const SIZE: (u32, u32) = (48, 32);

/// What a frame has shown, as far as tests ask for it.
struct Sight {
    film: Film,
    shown: Image,
    lag: Option<Lag>,
    rough: bool,
}

/// Sees each pass, and takes note of it.
struct Onlooker {
    denoise: DenoiseSettings,
    in_a_hurry: bool,
    seen: Mutex<Vec<Sight>>,
}

impl Watch for Onlooker {
    fn ends_now(&self) -> bool {
        self.in_a_hurry
    }

    fn ends_soon(&self, _spp: u32) -> bool {
        self.in_a_hurry
    }

    fn denoise(&self) -> DenoiseSettings {
        self.denoise
    }

    fn pacing(&self, _spent: Duration) -> Pacing {
        Pacing { pass: Duration::ZERO, show: Duration::ZERO, growth: 1 }
    }

    fn show(&self, frame: Frame) {
        let shown = frame.reused.as_ref().map_or_else(|| frame.film.image(), |reused| reused.image.clone());
        let lag = frame.reused.map(|reused| reused.lag);
        self.seen.lock().unwrap().push(Sight { film: frame.film.clone(), shown, lag, rough: frame.rough });
    }
}

struct Stage {
    renderer: ProgressiveRenderer,
    scene: Arc<scene::Scene>,
    settings: TracedSettings,
}

impl Stage {
    fn new(spp: u32, history: u32) -> Self {
        let scene = Arc::new(scene::builtin::named("cornell").unwrap());
        let settings = TracedSettings::from(TruthSettings { spp, ..TruthSettings::default() });
        let settings = TracedSettings { denoise: DenoiseSettings { history, ..DenoiseSettings::OFF }, ..settings };
        let renderer = ProgressiveRenderer::new(Adapters::default(), Arc::new(Threads::all()));
        Stage { renderer, scene, settings }
    }

    /// A view that is turned by this angle.
    fn request(&self, yaw: f32) -> Request {
        let camera = self.scene.camera.orbited(yaw, 0.0);
        let shot = Shot { scene: self.scene.clone(), camera, ..Shot::of((*self.scene).clone(), SIZE) };
        Request { shot, settings: self.settings, restarts: 0 }
    }

    fn onlooker(&self, in_a_hurry: bool) -> Onlooker {
        Onlooker { denoise: self.settings.denoise, in_a_hurry, seen: Mutex::default() }
    }

    /// All that is shown of it.
    fn look(&mut self, yaw: f32, in_a_hurry: bool) -> Vec<Sight> {
        let (request, onlooker) = (self.request(yaw), self.onlooker(in_a_hurry));
        self.renderer.render(&request, &onlooker).unwrap();
        onlooker.seen.into_inner().unwrap()
    }

    /// All that is shown of a film of it.
    fn film(&self, renderer: &mut Renderer, yaw: f32) -> Vec<Sight> {
        let (onlooker, TracedSettings { integrator, spp, .. }) = (self.onlooker(false), &self.settings);
        let mut film = Accumulation::blank(SIZE).unwrap();
        renderer.refine(&mut film, &self.request(yaw).shot.camera, (integrator, *spp), &onlooker);
        onlooker.seen.into_inner().unwrap()
    }

    /// What is shown of it where there is time for an eighth of the resolution alone.
    fn pass_by(&self, renderer: &mut Renderer, yaw: f32) -> Vec<Sight> {
        let (request, onlooker) = (self.request(yaw), self.onlooker(true));
        renderer.past.turn_to(&request, self.settings.denoise.history);
        renderer.speeds = crate::speeds::Speeds([1.0; 2]);
        assert!(renderer.show_moved(&request, &onlooker));
        onlooker.seen.into_inner().unwrap()
    }
}

fn square_error(image: &Image, truth: &Film) -> f32 {
    let pairs = image.radiances().iter().zip(truth.radiances());
    // a lamp is no noise
    pairs.map(|(value, truth)| (value.min(Vec3::splat(2.0)) - truth.min(Vec3::splat(2.0))).length_squared()).sum()
}

#[test]
fn a_view_that_was_moved_to_begins_with_the_last_one_and_ends_as_its_own_mean() {
    let mut stage = Stage::new(20, 8);
    assert!(
        stage.look(0.0, false).iter().all(|sight| sight.lag.is_none() && !sight.rough),
        "there is nothing before it"
    );
    let sights = stage.look(0.02, false);
    assert!(sights[0].rough && sights.iter().skip(1).all(|sight| !sight.rough));
    for sight in &sights {
        let samples = sight.film.samples_per_pixel();
        match sight.lag {
            Some(Lag { samples: earlier, seconds }) => {
                assert!(samples < 16 && (0.0..60.0).contains(&seconds), "{samples} samples, {seconds} s");
                // all but the edge of the picture has history, as far as it has faded
                let most = 8.0 * fade(samples, 16);
                assert!((0.8 * most..=most).contains(&earlier), "{earlier} of at most {most}");
            }
            None => assert!(samples >= 16 && sight.shown == sight.film.image()),
        }
    }
    let alone = Stage::new(20, 0).look(0.02, false);
    assert!(sights.last().unwrap().film == alone.last().unwrap().film, "history takes no part in the film");
    assert!(alone.iter().all(|sight| sight.lag.is_none() && !sight.rough));
}

/// Also one of fewer samples than earlier views count as.
#[test]
fn a_picture_that_is_done_is_the_mean_of_its_own_samples_and_stays_that() {
    let mut stage = Stage::new(6, 64);
    stage.look(0.0, false);
    let sights = stage.look(0.02, false);
    let (last, before) = sights.split_last().unwrap();
    assert!(before.iter().all(|sight| sight.lag.is_some()) && before.len() > 1);
    assert_eq!((last.film.samples_per_pixel(), last.lag), (6, None));
    assert!(last.shown == last.film.image());
    stage.settings.spp = 12;
    assert!(stage.look(0.02, false).iter().all(|sight| sight.lag.is_none()), "it has none of what comes after");
}

#[test]
fn a_drag_shows_each_view_it_comes_to_with_ever_less_noise() {
    const VIEWS: usize = 8;
    let mut stage = Stage::new(1, 64);
    stage.look(0.0, false);
    // pixels are all but at rest: with the random numbers of the last view they would have its noise
    let sights: Vec<Sight> = (1..=VIEWS).flat_map(|view| stage.look(1e-6 * view as f32, true)).collect();
    assert!(sights.len() == VIEWS && sights.iter().all(|sight| sight.rough && sight.lag.is_some()));
    let truth = Stage::new(512, 0).look(1e-6 * VIEWS as f32, false).pop().unwrap().film;
    let last = sights.last().unwrap();
    let (alone, together) = (square_error(&last.film.image(), &truth), square_error(&last.shown, &truth));
    // 9 pictures of one sample, of which clamping costs a part
    assert!(together < 0.2 * alone, "{together} of {alone}");
}

/// A film's first samples are those of the film before, and what both have in common no mean takes away.
#[test]
fn films_of_few_samples_are_no_history_beside_what_was_shown_of_the_move() {
    const VIEWS: usize = 8;
    let mut stage = Stage::new(1, 64);
    let views: Vec<Vec<Sight>> = (0..=VIEWS).map(|view| stage.look(1e-6 * view as f32, false)).collect();
    let truth = Stage::new(512, 0).look(1e-6 * VIEWS as f32, false).pop().unwrap().film;
    let [last, film] = &views[VIEWS][..] else { panic!("a picture of the move and a film of one sample") };
    assert!(last.rough && !film.rough && film.film.samples_per_pixel() == 1);
    let (alone, together) = (square_error(&last.film.image(), &truth), square_error(&last.shown, &truth));
    assert!(together < 0.2 * alone, "{together} of {alone}");
}

#[test]
fn what_changed_is_no_earlier_view() {
    let mut stage = Stage::new(2, 8);
    stage.look(0.0, false);
    let lags = |sights: Vec<Sight>| sights.iter().any(|sight| sight.lag.is_some());
    stage.settings.integrator = stage.settings.integrator.with_seed(7);
    assert!(!lags(stage.look(0.02, false)), "another setting");
    assert!(lags(stage.look(0.04, false)));
    stage.scene = Arc::new((*stage.scene).clone());
    assert!(!lags(stage.look(0.06, false)), "another scene");
    stage.settings.feature = Some(film::Feature::Albedo);
    assert!(!lags(stage.look(0.06, false)), "what is no light");
}

#[test]
fn coarse_pictures_of_a_drag_leave_the_whole_one_before_it_to_its_end() {
    const SPP: u32 = 26;
    let stage = Stage::new(SPP, 32);
    let mut renderer = Renderer::on_the_processor(stage.scene.clone(), Arc::new(Threads::all()));
    renderer.past.turn_to(&stage.request(0.0), 32);
    stage.film(&mut renderer, 0.0);
    for step in 1..=6 {
        let sights = stage.pass_by(&mut renderer, 0.002 * step as f32);
        assert!(sights.len() == 1 && sights[0].film.width() == SIZE.0 / 8 && sights[0].lag.is_some(), "step {step}");
    }
    let lag = stage.film(&mut renderer, 0.012)[0].lag.unwrap();
    // of all but edges, as after one step: coarse pictures stand for less than one sample
    let most = SPP as f32 * fade(1, SPP);
    assert!((0.8 * most..=most).contains(&lag.samples), "{lag:?} of at most {most}");
    // far away it shows nothing any more, and coarse pictures take over
    (1..=3).for_each(|step| drop(stage.pass_by(&mut renderer, 1.5 + 0.002 * step as f32)));
    renderer.past.turn_to(&stage.request(1.6), 32);
    let kept = renderer.past.earlier.as_ref().map(|shown| shown.pixels);
    assert_eq!(kept, Some(24), "of an eighth each way");
}

#[test]
fn a_slow_machine_moves_in_coarser_pictures() {
    let scene = Arc::new(scene::builtin::named("cornell").unwrap());
    let mut renderer = Renderer::on_the_processor(scene, Arc::new(Threads::all()));
    let affordable = |renderer: &Renderer| renderer.affordable((800, 600), 256);
    renderer.speeds = crate::speeds::Speeds([MOVING.as_secs_f64() / (800.0 * 600.0 * 2.5); 2]);
    assert_eq!(affordable(&renderer), ((800, 600), 2));
    renderer.speeds = crate::speeds::Speeds([MOVING.as_secs_f64() / 150_000.0; 2]);
    assert_eq!(affordable(&renderer), ((400, 300), 1));
    renderer.speeds = crate::speeds::Speeds([1.0; 2]);
    assert_eq!(affordable(&renderer), ((100, 75), 1));
}
