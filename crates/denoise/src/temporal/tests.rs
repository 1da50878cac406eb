use super::*;
use film::glam::Vec2;
use scene::Camera;

const SIZE: (u32, u32) = (48, 32);

/// A wall in the plane z = 0 and, where one is asked for, a narrow board before it; both with a texture in
/// the scene's own coordinates.
#[derive(Clone, Copy)]
struct Stage {
    camera: Camera,
    size: (u32, u32),
    board: bool,
}

const CAMERA: Camera =
    Camera { eye: Vec3::new(0.0, 0.0, 4.0), target: Vec3::ZERO, up: Vec3::Y, fov_y: 50.0, near: None, far: None };

const MIDDLE: Vec2 = Vec2::splat(0.5);

/// Half the width of the board, and how far before the wall it is.
const BOARD: [f32; 2] = [0.3, 1.0];

fn texture(point: Vec3) -> Vec3 {
    Vec3::new(1.0 + (2.0 * point.x).sin(), 2.0 + (3.0 * point.y).cos(), 1.0)
}

/// Uniform in [-.5, .5), of variance 1/12.
fn noise(seed: u32, pixel: usize) -> f32 {
    let hash = |v: u32| (v ^ (v >> 15)).wrapping_mul(0x2c1b_3c6d);
    hash(hash(pixel as u32 ^ seed.wrapping_mul(0x9e37_79b9)).rotate_left(13) ^ seed) as f32 / 4_294_967_296.0 - 0.5
}

/// What a camera sees of it.
struct Seen {
    frame: PictureFrame,
    points: Vec<Vec3>,
    features: Features,
}

impl Stage {
    fn from(camera: Camera) -> Self {
        Stage { camera, size: SIZE, board: false }
    }

    fn seen(self) -> Seen {
        let (width, height) = self.size;
        let frame = self.camera.frame(width as f32 / height as f32);
        let points: Vec<Vec3> = (0..width * height).map(|pixel| self.point(&frame, pixel, MIDDLE)).collect();
        let depth: Vec<f32> = points.iter().map(|point| (*point - frame.eye).length()).collect();
        let pixels = points.len();
        let features = Features::new(self.size, vec![Vec3::ONE; pixels], vec![Vec3::Z; pixels], depth).unwrap();
        Seen { frame, points, features }
    }

    fn point(self, frame: &PictureFrame, pixel: u32, within: Vec2) -> Vec3 {
        let (x, y) = (pixel % self.size.0, pixel / self.size.0);
        let at = (Vec2::new(x as f32, y as f32) + within) / Vec2::new(self.size.0 as f32, self.size.1 as f32);
        let direction = frame.direction(at);
        let on = |z: f32| frame.eye + direction * ((z - frame.eye.z) / direction.z);
        let before = on(BOARD[1]);
        if self.board && before.x.abs() <= BOARD[0] { before } else { on(0.0) }
    }
}

impl Seen {
    fn image(&self, of: impl Fn(usize, Vec3) -> Vec3) -> Image {
        let pixels: Vec<Vec3> = self.points.iter().enumerate().map(|(pixel, point)| of(pixel, *point)).collect();
        Image::new(self.features.size().0, self.features.size().1, pixels).unwrap()
    }

    fn now<'a>(&'a self, image: &'a Image, samples: &'a [u32]) -> Now<'a> {
        Now { frame: self.frame, image, samples, features: &self.features }
    }

    /// What its next view has of it, if all pixels have so many samples.
    fn history(&self, image: &Image, samples: u32) -> History {
        self.now(image, &vec![samples; self.points.len()]).history(None).unwrap()
    }

    /// A picture with so much noise along each axis of colour that nothing is clamped.
    fn unclamped(&self) -> Image {
        let kind = |pixel: usize| (pixel + pixel / SIZE.0 as usize) % 4;
        self.image(|pixel, _| Vec3::AXES.get(kind(pixel)).map_or(Vec3::ZERO, |axis| 100.0 * *axis))
    }
}

const REUSE: Reuse = Reuse { limit: 64, until: 128, elapsed: 0.25 };

fn put_together(seen: &Seen, image: &Image, history: &History, reuse: Reuse) -> Accumulated {
    accumulate(&seen.now(image, &vec![1; seen.points.len()]), history, reuse, &|| false).unwrap()
}

/// What history alone says of each pixel: that and one sample are told apart by the counts.
fn of_history(seen: &Seen, image: &Image, mixed: &Accumulated) -> Vec<Option<Vec3>> {
    let pixels = mixed.image.radiances().iter().zip(image.radiances()).zip(&mixed.earlier);
    pixels
        .map(|((mixed, own), h)| (*h > 0.0).then(|| (*mixed * (1.0 + h) - *own) / *h))
        .take(seen.points.len())
        .collect()
}

/// The farthest that what history says is from the truth, where its four nearest pixels are in the picture, and
/// of how many pixels.
fn worst(seen: &Seen, then: &Seen, history: &History, truth: impl Fn(Vec3) -> Vec3) -> (f32, usize) {
    let own = seen.unclamped();
    let found = of_history(seen, &own, &put_together(seen, &own, history, REUSE));
    let margin = 0.5 / SIZE.1 as f32;
    let inner = |place: Vec2| place.min_element() >= margin && place.max_element() <= 1.0 - margin;
    let is_inside = |point: Vec3| then.frame.project(point).is_some_and(inner);
    let inside = found.iter().zip(&seen.points).filter(|(_, point)| is_inside(**point));
    let errors = inside.map(|(found, point)| found.map_or(f32::INFINITY, |f| (f - truth(*point)).abs().max_element()));
    errors.fold((0.0, 0), |(most, count), error| (error.max(most), count + 1))
}

#[test]
fn a_wall_is_found_again_from_another_camera_to_a_fraction_of_a_pixel() {
    let moves = [CAMERA.orbited(0.12, -0.05), CAMERA.panned(Vec2::new(0.03, 0.02)), CAMERA.dollied(1.05)];
    let then = Stage::from(CAMERA).seen();
    let history = then.history(&then.image(|_, point| texture(point)), 64);
    for camera in moves {
        // a pixel is .12 wide there and the texture's slope at most 3, its curve at most 9: a tenth of a pixel, of which
        // half is what straight lines miss of the curve
        let (most, pixels) = worst(&Stage::from(camera).seen(), &then, &history, texture);
        assert!(most < 0.035 && pixels * 10 > then.points.len() * 8, "{camera:?}: {most} of {pixels}");
    }
}

#[test]
fn what_comes_from_behind_a_board_has_no_history() {
    let stage = |eye: f32| Stage { board: true, ..Stage::from(Camera { eye: Vec3::new(eye, 0.0, 4.0), ..CAMERA }) };
    let (before, now) = (stage(-0.4).seen(), stage(0.4).seen());
    let red_board = |seen: &Seen| seen.image(|_, point| if point.z > 0.5 { Vec3::X } else { Vec3::Y });
    let history = before.history(&red_board(&before), 64);
    let own = now.image(|_, _| Vec3::ZERO);
    let mixed = put_together(&now, &own, &history, REUSE);
    let was_hidden = |point: Vec3| {
        let arm = point - before.frame.eye;
        let crossing = before.frame.eye + arm * ((BOARD[1] - before.frame.eye.z) / arm.z);
        point.z < 0.5 && crossing.x.abs() < 0.8 * BOARD[0]
    };
    let hidden = || now.points.iter().zip(&mixed.earlier).filter(|(point, _)| was_hidden(**point));
    assert!(hidden().count() > 20 && hidden().all(|(_, h)| *h == 0.0), "they were behind the board");
    let red = mixed.image.radiances().iter().zip(&now.points).filter(|(light, point)| point.z < 0.5 && light.x > 0.0);
    assert_eq!(red.count(), 0, "none of the wall has the board's colour");
    let other =
        Features::new(SIZE, now.features.albedo.clone(), vec![Vec3::X; now.points.len()], now.features.depth.clone());
    let turned = Seen { features: other.unwrap(), ..stage(0.4).seen() };
    let mixed = put_together(&turned, &own, &history, REUSE);
    assert!(mixed.earlier.iter().all(|h| *h == 0.0), "a surface that faces elsewhere is another one");
    let Features { normal, depth, .. } = now.features;
    let black = Features::new(SIZE, vec![Vec3::ZERO; now.points.len()], normal, depth).unwrap();
    let painted = Seen { features: black, ..stage(0.4).seen() };
    let mixed = put_together(&painted, &own, &history, REUSE);
    assert!(mixed.earlier.iter().all(|h| *h == 0.0), "and so is one of another colour");
}

/// The light of a square lamp in the wall or of the wall beside it, and the albedo that features tell.
fn lamp(point: Vec3) -> [f32; 2] {
    if point.x.abs().max(point.y.abs()) < 0.5 { [17.0, 1.0] } else { [0.3, 0.7] }
}

impl Stage {
    /// With the lamp: its light is the mean over each pixel, and its features are of one sample, anywhere in it.
    fn lit(self, seed: u32) -> (Seen, Image) {
        const GRID: u32 = 8;
        let mut seen = self.seen();
        let point = |pixel: usize, within: Vec2| self.point(&seen.frame, pixel as u32, within);
        let any = |pixel: usize| MIDDLE + Vec2::new(noise(seed, pixel), noise(seed + 1, pixel));
        let albedo: Vec<Vec3> = (0..seen.points.len()).map(|p| Vec3::splat(lamp(point(p, any(p)))[1])).collect();
        let cells =
            || (0..GRID * GRID).map(|cell| (Vec2::new((cell % GRID) as f32, (cell / GRID) as f32) + 0.5) / GRID as f32);
        let mean = |pixel: usize| cells().map(|cell| lamp(point(pixel, cell))[0]).sum::<f32>() / (GRID * GRID) as f32;
        let image = seen.image(|pixel, _| Vec3::splat(mean(pixel)));
        seen.features.albedo = albedo.into();
        (seen, image)
    }
}

/// Their clamp has the lamp in it, and depth and normal are those of the wall.
#[test]
fn pixels_beside_a_lamp_take_no_light_of_it_from_a_coarser_history() {
    let fine = Stage::from(CAMERA.panned(Vec2::new(0.013, 0.009)));
    for shrink in [2, 4] {
        let (then, light) = Stage { size: (SIZE.0 / shrink, SIZE.1 / shrink), ..Stage::from(CAMERA) }.lit(7);
        let history = then.history(&light, 64);
        let (now, own) = fine.lit(3);
        let mixed = put_together(&now, &own, &history, REUSE);
        let whole = |truth: &Vec3| [0.3, 17.0].iter().any(|light| (truth.x - light).abs() < 1e-3);
        let pairs = mixed.image.radiances().iter().zip(own.radiances());
        let errors = pairs.filter(|(_, truth)| whole(truth)).map(|(light, truth)| (*light / *truth - 1.0).x.abs());
        let most = errors.clone().fold(0.0, f32::max);
        assert!(most < 0.02 && errors.count() > 1400, "1/{shrink}: {most}");
        let with_history = mixed.earlier.iter().filter(|h| **h > 0.0).count();
        assert!(with_history > now.points.len() / 2, "1/{shrink}: {with_history} pixels beside it have history");
    }
}

#[test]
fn what_changes_is_followed_as_far_as_neighbours_tell() {
    let seen = Stage::from(CAMERA).seen();
    let bright = seen.image(|_, _| Vec3::splat(10.0));
    let history = seen.history(&bright, 64);
    let dark = seen.image(|_, _| Vec3::splat(1.0));
    let mixed = put_together(&seen, &dark, &history, REUSE);
    assert!(
        mixed.image.radiances().iter().all(|light| (*light - 1.0).abs().max_element() < 1e-5),
        "a clean one at once"
    );
    let noisy = seen.image(|pixel, _| Vec3::splat(1.0 + noise(1, pixel)));
    let mixed = put_together(&seen, &noisy, &history, REUSE);
    // two standard deviations of noise are .58, and those of 25 neighbours vary
    let most = mixed.image.radiances().iter().fold(0.0, |most: f32, light| most.max(light.max_element()));
    assert!((1.3..1.9).contains(&most), "{most}");
}

#[test]
fn a_picture_of_a_camera_that_stands_is_in_the_end_the_mean_of_its_samples() {
    let seen = Stage::from(CAMERA).seen();
    let own = seen.image(|pixel, _| Vec3::splat(1.0 + noise(1, pixel)));
    let history = seen.history(&seen.image(|_, _| Vec3::splat(1.2)), 64);
    let of = |samples: u32| {
        let samples = vec![samples; seen.points.len()];
        let reuse = Reuse { limit: 16, until: 32, elapsed: 0.0 };
        accumulate(&seen.now(&own, &samples), &history, reuse, &|| false).unwrap()
    };
    assert_eq!([1, 8, 16, 24, 32, 99].map(|samples| of(samples).earlier[0]), [15.5, 12.0, 8.0, 4.0, 0.0, 0.0]);
    assert!(of(31).image != own && of(31).age[0] == 0.0, "as old as it is");
    assert_eq!((of(32).image, of(32).age), (own.clone(), vec![0.0; seen.points.len()]));
}

/// A pan by whole pixels: what is left of the noise is what its mean over the frames leaves.
#[test]
fn the_variance_of_a_slow_pan_falls_as_one_over_the_frames() {
    const FRAMES: u32 = 8;
    let pixel = 1.0 / SIZE.1 as f32;
    let mut history: Option<History> = None;
    let mut variance = Vec::new();
    for frame in 0..FRAMES {
        let seen = Stage::from(CAMERA.panned(Vec2::new(pixel * frame as f32, 0.0))).seen();
        let own = seen.image(|pixel, _| Vec3::splat(1.0 + noise(frame + 1, pixel)));
        let samples = vec![1; seen.points.len()];
        let now = seen.now(&own, &samples);
        let reuse = Reuse { limit: 256, until: 512, elapsed: 0.5 };
        let mixed = history.as_ref().map(|history| accumulate(&now, history, reuse, &|| false).unwrap());
        let shown = mixed.as_ref().map_or(&own, |mixed| &mixed.image);
        // columns that have been in all frames
        let kept = shown.radiances().iter().enumerate().filter(|(pixel, _)| pixel % SIZE.0 as usize >= FRAMES as usize);
        let squares: Vec<f32> = kept.map(|(_, light)| (light.x - 1.0).powi(2)).collect();
        variance.push(squares.iter().sum::<f32>() / squares.len() as f32);
        let next = now.history(mixed.as_ref()).unwrap();
        if let Some(mixed) = &mixed {
            // it is of 0, .5, 1, ... seconds ago, as much of each
            let (age, count) = (mixed.age[SIZE.0 as usize - 1], mixed.earlier[SIZE.0 as usize - 1]);
            assert!((age - 0.25 * frame as f32).abs() < 0.02 * frame as f32, "frame {frame}: {age} s");
            assert!((count - frame as f32).abs() < 0.02 * frame as f32, "frame {frame}: {count} samples");
        }
        history = Some(next);
    }
    let left = variance[FRAMES as usize - 1] / variance[0];
    // 1/8; of 1300 pixels the spread of a variance is 4 %, and rounding of places blurs a little
    assert!((0.1..0.14).contains(&left), "{left} of the variance is left: {variance:?}");
}

/// What is wrong in the last of some pictures of one sample that see the lamp go by so many pixels each, alone and put together with
/// those before; a lamp counts as little more than the wall.
fn errors_of_a_pan(by: f32) -> [f32; 2] {
    let mut history: Option<History> = None;
    let mut errors = [0.0; 2];
    for frame in 0..12 {
        let shift = Vec2::new(1.0, 0.7) * (by * frame as f32 / SIZE.1 as f32);
        let stage = Stage::from(CAMERA.panned(shift));
        let (mut seen, truth) = stage.lit(3);
        let place = |p: usize| MIDDLE + Vec2::new(noise(2 * frame + 50, p), noise(2 * frame + 51, p));
        let met = |p: usize| lamp(stage.point(&seen.frame, p as u32, place(p)));
        let albedo: Vec<Vec3> = (0..seen.points.len()).map(|p| Vec3::splat(met(p)[1])).collect();
        let own = seen.image(|p, _| Vec3::splat(met(p)[0] * (1.0 + noise(frame + 100, p))));
        seen.features.albedo = albedo.into();
        let mixed = history.as_ref().map(|history| put_together(&seen, &own, history, REUSE));
        let shown = mixed.as_ref().map_or(&own, |mixed| &mixed.image);
        let difference = |(a, b): (&Vec3, &Vec3)| (a.x.min(2.0) - b.x.min(2.0)).powi(2);
        errors = [&own, shown].map(|image| image.radiances().iter().zip(truth.radiances()).map(difference).sum());
        history = Some(seen.now(&own, &vec![1; seen.points.len()]).history(mixed.as_ref()).unwrap());
    }
    errors
}

#[test]
fn an_edge_becomes_smooth_at_rest_and_is_not_blurred_while_it_moves() {
    let [alone, together] = errors_of_a_pan(1e-4);
    // 12 samples for one, with what the clamp costs
    assert!(together < 0.15 * alone, "{together} of {alone}");
    let [alone, together] = errors_of_a_pan(0.3);
    assert!(together < 0.8 * alone, "{together} of {alone}");
}

#[test]
fn a_coarser_picture_counts_by_its_share_of_samples() {
    let coarse = Stage { size: (SIZE.0 / 2, SIZE.1 / 2), ..Stage::from(CAMERA) }.seen();
    let fine = Stage::from(CAMERA).seen();
    let count = |then: &Seen, now: &Seen| {
        let history = then.history(&then.image(|_, _| Vec3::ONE), 8);
        let own = now.image(|_, _| Vec3::ONE);
        put_together(now, &own, &history, REUSE).earlier[now.points.len() / 2 + now.features.size().0 as usize / 2]
    };
    let fade = fade(1, REUSE.until);
    assert!((count(&coarse, &fine) - 2.0 * fade).abs() < 1e-3, "of four pixels one has a quarter");
    assert!((count(&fine, &coarse) - 32.0 * fade).abs() < 1e-3, "and of one four");
    let near = Stage::from(CAMERA.dollied(2.0)).seen();
    assert!((count(&fine, &near) - 2.0 * fade).abs() < 0.1, "and so it is from half the distance");
}

#[test]
fn the_sky_is_found_by_its_direction() {
    let sky = |camera: Camera| {
        let mut seen = Stage::from(camera).seen();
        let pixels = seen.points.len();
        let (none, far) = (vec![Vec3::ZERO; pixels], vec![f32::INFINITY; pixels]);
        seen.features = Features::new(SIZE, none.clone(), none, far).unwrap();
        seen.points.iter_mut().for_each(|point| *point = (*point - camera.eye).normalize());
        seen
    };
    let before = sky(CAMERA);
    let history = before.history(&before.image(|_, direction| texture(4.0 * direction)), 64);
    let turned = Camera { eye: CAMERA.eye + Vec3::X, target: CAMERA.target + Vec3::new(1.2, 0.0, 0.0), ..CAMERA };
    let of_direction = |point: Vec3| texture(4.0 * (point - CAMERA.eye));
    let mut now = sky(turned);
    now.points.iter_mut().for_each(|direction| *direction += CAMERA.eye);
    let (most, pixels) = worst(&now, &before, &history, of_direction);
    assert!(most < 0.035 && pixels > SIZE.0 as usize * 20, "{most} of {pixels}");
}

#[test]
fn small_pictures_and_what_is_no_number_leave_the_rest_alone() {
    for size in [(1, 1), (7, 3), (0, 0)] {
        let seen = Stage { size, ..Stage::from(CAMERA) }.seen();
        let (own, then) = (seen.image(|_, _| Vec3::ONE), seen.image(|_, _| Vec3::ONE));
        let mixed = put_together(&seen, &own, &seen.history(&then, 4), REUSE);
        assert_eq!((mixed.image.size(), mixed.earlier.len()), (size, own.radiances().len()));
        assert!(mixed.earlier.iter().all(|h| *h > 0.0) && mixed.image == own, "{size:?}");
    }
    let mut seen = Stage::from(CAMERA).seen();
    let strange = [f32::NAN, f32::INFINITY, f32::MAX, -1.0];
    let odd = |pixel: usize| strange.get(pixel / 300).copied().filter(|_| pixel % 300 == 7);
    let depth: Vec<f32> =
        seen.features.depth.iter().enumerate().map(|(pixel, depth)| odd(pixel).unwrap_or(*depth)).collect();
    let normal: Vec<Vec3> = (0..depth.len()).map(|pixel| odd(pixel + 90).map_or(Vec3::Z, Vec3::splat)).collect();
    seen.features = Features::new(SIZE, seen.features.albedo.clone(), normal, depth).unwrap();
    let light = |pixel: usize| Vec3::splat(odd(pixel + 50).unwrap_or(1.0));
    let history = seen.history(&seen.image(|pixel, _| light(pixel + 40)), 64);
    let own = seen.image(|pixel, _| light(pixel));
    let mixed = put_together(&seen, &own, &history, REUSE);
    // without samples of its own a pixel has nothing to be clamped to
    let none = accumulate(&seen.now(&own, &vec![0; own.radiances().len()]), &history, REUSE, &|| false).unwrap();
    let with_history = none.image.radiances().iter().zip(&none.earlier).filter(|(_, h)| **h > 0.0);
    assert!(with_history.clone().count() > 1000 && with_history.clone().all(|(light, _)| light.is_finite()));
    let sound = |pixel: usize| light(pixel) == Vec3::ONE;
    let pixels = mixed.image.radiances().iter().zip(&mixed.age).enumerate().filter(|(pixel, _)| sound(*pixel));
    for (pixel, (light, age)) in pixels {
        assert!(light.is_finite() && light.min_element() >= 0.0 && age.is_finite(), "{pixel}: {light} {age}");
    }
}

#[test]
fn it_stops_when_asked_and_refuses_layers_of_another_size() {
    let seen = Stage::from(CAMERA).seen();
    let own = seen.image(|_, _| Vec3::ONE);
    let (samples, history) = (vec![1; seen.points.len()], seen.history(&own, 1));
    let now = seen.now(&own, &samples);
    assert_eq!(accumulate(&now, &history, REUSE, &|| true), Err(DenoiseError::Stopped));
    assert_eq!(accumulate(&Now { samples: &[1], ..now }, &history, REUSE, &|| false), Err(DenoiseError::Size));
    assert!(Now { samples: &[1], ..now }.history(None).is_err());
}
