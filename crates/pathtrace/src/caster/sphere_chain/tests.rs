use super::*;
use crate::sampling::sampler::Sampler;
use scene::glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// A chain in f64: whether it goes through, distances of both ends (the far one may be infinite), index.
#[derive(Debug, Clone, Copy)]
struct Exact {
    through: bool,
    near: f64,
    far: f64,
    ior: f64,
}

impl Exact {
    fn random(index: u32, seed: u32) -> Self {
        let sampler = Sampler::independent(0, index, seed);
        let [a, b, c, d] = sampler.unit4(0).map(f64::from);
        let far = if d < 0.3 { f64::INFINITY } else { 1.0 + 9.0 * ((d - 0.3) / 0.7).powi(3) + 1e-3 };
        // as they are in f32
        let [near, far, ior] = [1.0 + 6.0 * a * a + 1e-3, far, 1.02 + 1.4 * b].map(|x| f64::from(x as f32));
        Exact { through: c < 0.7, near, far, ior }
    }

    fn lanes(&self) -> SphereChains<f32> {
        let far = if self.far.is_finite() { Ratio::inverse(self.far as f32) } else { Ratio::zero() };
        SphereChains::new(self.through, Ratio::inverse(self.near as f32), far, Ratio::inverse(self.ior as f32))
    }

    fn turn(&self, i: f64) -> f64 {
        let of = |length: f64| (i.sin() / length).asin();
        let inside = if self.through { 2.0 * of(self.ior) } else { 0.0 };
        2.0 * i - of(self.near) - of(self.far) - inside
    }

    fn slope(&self, i: f64) -> f64 {
        let of = |length: f64| i.cos() / (length * length - i.sin().powi(2)).sqrt();
        let far = if self.far.is_finite() { of(self.far) } else { 0.0 };
        2.0 - of(self.near) - far - if self.through { 2.0 * of(self.ior) } else { 0.0 }
    }

    /// The incidence at which the turn is least.
    fn fold(&self) -> f64 {
        if self.slope(0.0) >= 0.0 { 0.0 } else { bisect(|i| self.slope(i), 0.0, FRAC_PI_2) }
    }

    /// By bisection of each branch, as [`SphereChains::root`] numbers them.
    fn roots(&self, angle: f64) -> [Option<f64>; 3] {
        let fold = self.fold();
        let rising = |target: f64| {
            let there = self.turn(fold) <= target && target <= self.turn(FRAC_PI_2);
            there.then(|| bisect(|i| self.turn(i) - target, fold, FRAC_PI_2))
        };
        let falls = self.through && fold > 0.0 && self.turn(fold) <= -angle;
        let falling = falls.then(|| bisect(|i| -angle - self.turn(i), 0.0, fold));
        let own_side = if falls { rising(-angle) } else { None };
        [rising(angle), own_side, falling]
    }

    /// Where a ray from the near end, which lies on the axis of z, leaves the sphere, and its direction then.
    fn trace(&self, w: DVec3) -> Option<(DVec3, DVec3)> {
        let p = DVec3::Z * self.near;
        let along = -p.dot(w);
        let within = 1.0 - (p + w * along).length_squared();
        let first = p + w * (along - within.max(0.0).sqrt());
        let cos = -w.dot(first);
        if within < 0.0 {
            return None;
        }
        if !self.through {
            return Some((first, w + first * (2.0 * cos)));
        }
        let inner = (1.0 - (1.0 - cos * cos) / (self.ior * self.ior)).sqrt();
        let inside = w / self.ior + first * (cos / self.ior - inner);
        let last = first + inside * (2.0 * inner);
        Some((last, inside * self.ior + last * (cos - inner * self.ior)))
    }
}

fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Whether f32 cannot know if there is a root: the target is a fold's turn, or that of grazing incidence, but for
/// roundings of a few angles.
fn is_open(chain: &Exact, angle: f64) -> bool {
    let (fold, last) = (chain.turn(chain.fold()), chain.turn(FRAC_PI_2));
    [angle - last, -angle - fold, angle - fold].iter().any(|x| x.abs() < 4e-6)
}

fn angle_of(root: &Root<f32>) -> f64 {
    f64::from(root.incidence.sin).atan2(f64::from(root.incidence.cos))
}

/// 60,000 chains; every third has an angle near the fold, where plain Newton runs away. A root's turn may be off by a few
/// roundings of angles.
#[test]
fn roots_are_those_of_bisection_none_missed_and_none_invented() {
    let (mut found, mut three) = (0, 0);
    for index in 0..60_000 {
        let chain = Exact::random(index, 31);
        let [u, v, ..] = Sampler::independent(1, index, 31).unit4(0).map(f64::from);
        let near_fold = -chain.turn(chain.fold()) + 1e-2 * (v - 0.5).powi(3);
        let angle = if index % 3 == 0 && near_fold > 0.0 { near_fold } else { PI * u };
        let angle = f64::from(angle as f32);
        if is_open(&chain, angle) {
            continue;
        }
        let (lanes, exact) = (chain.lanes(), chain.roots(angle));
        for (index, exact) in (0..MOST_ROOTS).zip(exact) {
            let root = lanes.root(index, angle as f32, true);
            assert_eq!(root.found, exact.is_some(), "{chain:?} {angle} {index}: {exact:?}");
            let Some(exact) = exact else { continue };
            let (i, target) = (angle_of(&root), if index == 0 { angle } else { -angle });
            assert!((chain.turn(i) - target).abs() < 3e-6, "{chain:?} {angle} {index}: {i} {exact}");
            let side = if index == 2 { i <= chain.fold() + 1e-3 } else { i >= chain.fold() - 1e-3 };
            assert!(side && root.crosses == (chain.through && index == 0));
            found += 1;
        }
        three += usize::from(exact.iter().all(Option::is_some));
    }
    assert!(found > 35_000 && three > 2_000, "{found} {three}");
}

/// Follows rays, finds them again as roots from both their ends, and holds the density against how far apart their
/// neighbours arrive.
#[test]
fn the_density_is_that_of_traced_rays() {
    let mut checked = 0;
    for index in 0..20_000 {
        let chain = Exact::random(index, 32);
        let [u, v, ..] = Sampler::independent(1, index, 32).unit4(0).map(f64::from);
        let sine = u.sqrt() / chain.near;
        let w = DVec3::new(sine, 0.0, -(1.0 - sine * sine).sqrt());
        let Some((last, direction)) = chain.trace(w) else { continue };
        // the far end lies on the ray
        let y = if chain.far.is_finite() { last + direction * (3.0 * v + 1e-2) } else { direction * 1e9 };
        let chain = Exact { far: if chain.far.is_finite() { y.length() } else { chain.far }, ..chain };
        let arrives = |dx: f64, dy: f64| {
            let (last, d) = chain.trace((w + DVec3::new(dx, dy, 0.0)).normalize())?;
            let on_plane = last + d * ((y - last).dot(direction) / d.dot(direction));
            Some(if chain.far.is_finite() { on_plane / chain.far } else { d })
        };
        let h = 1e-6;
        let [Some(a), Some(b), Some(c), Some(d)] =
            [arrives(h, 0.0), arrives(-h, 0.0), arrives(0.0, h), arrives(0.0, -h)]
        else {
            continue;
        };
        // a step along x turns the direction by less than that
        let exact = (a - b).cross(c - d).length() / (4.0 * h * h * w.z.abs());
        let reference = if chain.through { -DVec3::Z } else { DVec3::Z };
        let far = y.normalize();
        let (sin_angle, cos_angle) = (reference.cross(far).length(), reference.dot(far));
        let lanes = chain.lanes();
        let roots = (0..MOST_ROOTS).map(|index| lanes.root(index, sin_angle.atan2(cos_angle) as f32, true));
        let i = u.sqrt().asin();
        // at grazing incidence neighbours are too far apart
        if i > 1.5 || is_open(&chain, sin_angle.atan2(cos_angle)) {
            continue;
        }
        let nearest = roots.filter(|root| root.found).min_by(|a, b| {
            let [a, b] = [a, b].map(|root| (angle_of(root) - i).abs());
            a.total_cmp(&b)
        });
        // near a fold the incidence is known to the root of what the turn is
        let tolerance = 5e-6 / chain.slope(i).abs().max(2e-3);
        let root = nearest.unwrap_or_else(|| panic!("{chain:?}: {i} is lost"));
        assert!((angle_of(&root) - i).abs() < tolerance, "{chain:?}: {} {i}", angle_of(&root));
        let incidence = Incidence { sin: i.sin() as f32, cos: i.cos() as f32 };
        let density = f64::from(lanes.density(incidence, sin_angle as f32));
        assert!((density - exact).abs() < 2e-4 * exact + 1e-5, "{chain:?}: {density} {exact} at {i}");
        checked += 1;
    }
    assert!(checked > 15_000, "{checked}");
}

/// On the axis both sines of the density vanish together: it is continuous there.
#[test]
fn the_density_has_its_limit_on_the_axis() {
    let chain = Exact { through: true, near: 3.3, far: f64::INFINITY, ior: 1.0 / 0.7 }.lanes();
    let at = |angle: f32| {
        let root = chain.root(0, angle, true);
        assert!(root.found);
        chain.density(root.incidence, angle.sin())
    };
    let middle = at(0.0);
    // (1 - 2 (n - 1) D / n)^2
    assert!((middle - (1.0f32 - 2.0 * 0.3 * 3.3).powi(2)).abs() < 1e-5, "{middle}");
    for angle in [1e-5, 1e-4, 2e-4, 2.5e-4, 1e-3] {
        assert!((at(angle) / middle - 1.0).abs() < 1e-3, "{angle}: {} {middle}", at(angle));
    }
}
