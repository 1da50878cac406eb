//! Rays by way of one sphere, as the device finds them: every root that bisection finds and no other, with the density
//! that traced rays have. Through Vulkan and through OpenGL.

#[allow(dead_code, reason = "other tests run more kinds of functions")]
mod twin;

use scene::builtin;
use std::f64::consts::{FRAC_PI_2, PI};
use twin::{ITEMS, units};

/// A sphere as rays from a vertex to an end meet it, lengths in radii.
#[derive(Debug, Clone, Copy)]
struct Chain {
    through: bool,
    inverse_distance: f64,
    inverse_end: f64,
    inverse_ior: f64,
}

/// A shader's body after one that reads a chain: whether it goes through, and three lengths.
fn chained(body: &str) -> String {
    let ratio = |at: u32| format!("inverse_ratio(f(at + {at}u))");
    format!(
        "var far = {}; if f(at + 2u) > 1e8 {{ far = zero_ratio(); }}
        let chain = sphere_chain(numbers[at] == 1u, {}, far, {}); {body}",
        ratio(2),
        ratio(1),
        ratio(3)
    )
}

impl Chain {
    /// The angle by which a ray of this incidence is turned.
    fn turn(&self, i: f64) -> f64 {
        let passing = |inverse: f64| -(i.sin() * inverse).asin();
        let glass = if self.through { 2.0 * passing(self.inverse_ior) } else { 0.0 };
        2.0 * i + passing(self.inverse_distance) + passing(self.inverse_end) + glass
    }

    fn slope(&self, i: f64) -> f64 {
        let passing = |inverse: f64| -i.cos() * inverse / (1.0 - (i.sin() * inverse).powi(2)).sqrt();
        let glass = if self.through { 2.0 * passing(self.inverse_ior) } else { 0.0 };
        2.0 + passing(self.inverse_distance) + passing(self.inverse_end) + glass
    }

    /// Where the turn is smallest: it is convex.
    fn fold(&self) -> f64 {
        bisect(0.0, FRAC_PI_2, |i| self.slope(i) > 0.0)
    }
}

/// The place between `low` and `high` from which on `above` holds.
fn bisect(mut low: f64, mut high: f64, above: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if above(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Distances from touching to far beyond, suns among the ends; indices from almost none to diamond.
fn chain(item: u32) -> Chain {
    let [a, b, c, d] = units(item, 40).map(f64::from);
    let rounded = |length: f64| 1.0 / f64::from(length as f32);
    let inverse_end = if item.is_multiple_of(3) { 0.0 } else { rounded(1.001 / b) };
    let (inverse_distance, inverse_ior) = (rounded(1.001 / a.max(1e-3)), rounded(1.02 + 1.4 * c));
    Chain { through: d < 0.75, inverse_distance, inverse_end, inverse_ior }
}

/// Angles anywhere, and where a fold's two roots are one or just are none.
fn angle(item: u32) -> f32 {
    let [a, b, ..] = units(item, 41);
    let fold = -chain(item).turn(chain(item).fold()) as f32;
    let near = fold + fold * (b - 0.5) * 10f32.powf(-5.0 * a);
    if item.is_multiple_of(4) && fold > 0.0 { near.clamp(0.0, PI as f32) } else { a * PI as f32 }
}

/// Off a fold's branch by so little in the turn that rounding decides.
const ROUNDING: f64 = 2e-6;

#[test]
fn roots_on_the_device_are_those_of_bisection() {
    let given = twin::input(|item| {
        let Chain { through, inverse_distance, inverse_end, inverse_ior } = chain(item);
        let words = [inverse_distance, inverse_end, inverse_ior].map(|x| ((1.0 / x.max(1e-9)) as f32).to_bits());
        [u32::from(through), words[0], words[1], words[2], angle(item).to_bits(), 0, 0, 0]
    });
    let body = "var found = vec3f(-1.0);
        for (var index = 0u; index < roots_at_most(chain); index++) {
            let root = chain_root(chain, index, f(at + 4u));
            if root.found { found[index] = angle_of_sine(root.incidence.x, root.incidence.y); }
        }
        return bits(found.x, found.y, found.z, 0.0);";
    let body = &chained(body);
    for tracer in twin::devices(&builtin::named("cornell").unwrap()) {
        let on_gpu = twin::run(&tracer, "pathtrace/caster/sphere_chain.wgsl", body, &[], &given);
        let (mut roots, mut three, mut worst) = (0, 0, 0f64);
        for item in 0..ITEMS {
            let (chain, angle) = (chain(item), f64::from(angle(item)));
            let found = on_gpu[item as usize].map(f32::from_bits);
            let expected = chain.roots(angle);
            for (k, (found, (root, target))) in found.into_iter().zip(expected).enumerate() {
                let edge = chain.margin(target);
                if (found >= 0.0) != root.is_some() {
                    assert!(edge < ROUNDING, "item {item}, root {k}: {found} for {root:?}, {edge}: {chain:?} {angle}");
                    continue;
                }
                if found >= 0.0 {
                    let off = (chain.turn(f64::from(found)) - target).abs();
                    worst = worst.max(off);
                    roots += 1;
                    assert!(off < 5e-6, "item {item}, root {k}: {found} for {root:?}, off by {off}: {chain:?} {angle}");
                }
            }
            three += u32::from(found[..3].iter().all(|&i| i >= 0.0));
        }
        println!("{}: {roots} roots, {three} times three, turn off by {worst}", tracer.gpu().describe());
        assert!(roots > ITEMS as usize / 2 && three > 100);
    }
}

impl Chain {
    /// Roots by bisection with the turn that each is at: as `roots` of the shader has them.
    fn roots(&self, angle: f64) -> [(Option<f64>, f64); 3] {
        let fold = self.fold();
        let rising = |target: f64| {
            let met = self.turn(fold) <= target && target <= self.turn(FRAC_PI_2);
            met.then(|| bisect(fold, FRAC_PI_2, |i| self.turn(i) > target))
        };
        let falling = |target: f64| {
            let met = self.turn(fold) <= target && target <= 0.0;
            met.then(|| bisect(0.0, fold, |i| self.turn(i) < target))
        };
        let folds = self.through && self.slope(0.0) < 0.0;
        let near = |root: Option<f64>| root.filter(|_| folds);
        [(rising(angle), angle), (near(rising(-angle)), -angle), (near(falling(-angle)), -angle)]
    }

    /// How far a turn is from where a branch ends.
    fn margin(&self, target: f64) -> f64 {
        [self.turn(self.fold()), self.turn(FRAC_PI_2), 0.0]
            .map(|end| (end - target).abs())
            .into_iter()
            .fold(PI, f64::min)
    }
}

/// Density at the vertex over that at the centre, by rays a little to both sides.
fn ratio_of_rays(chain: &Chain, i: f64) -> f64 {
    let step = 1e-6;
    let theta = |i: f64| (i.sin() * chain.inverse_distance).asin();
    let by = |of: &dyn Fn(f64) -> f64| of(i).sin() * (of(i + step) - of(i - step)) / (2.0 * step);
    (by(&|i| chain.turn(i)) / by(&theta)).abs()
}

#[test]
fn densities_on_the_device_are_those_of_traced_rays() {
    let incidence = |item: u32| (units(item, 42)[0] * 0.98 * FRAC_PI_2 as f32).max(1e-4);
    let given = twin::input(|item| {
        let Chain { through, inverse_distance, inverse_end, inverse_ior } = chain(item);
        let lengths = [inverse_distance.max(0.01), inverse_end, inverse_ior];
        let words = lengths.map(|x| ((1.0 / x.max(1e-9)) as f32).to_bits());
        [u32::from(through), words[0], words[1], words[2], incidence(item).to_bits(), 0, 0, 0]
    });
    let body = "let i = sin_cos(f(at + 4u));
        let sine = sin_cos(abs(turn(chain, f(at + 4u), i).x)).x;
        return bits(chain_density(chain, i, sine) / ratio_cosine(chain.far, i.y), 0.0, 0.0, 0.0);";
    let body = &chained(body);
    for tracer in twin::devices(&builtin::named("cornell").unwrap()) {
        let on_gpu = twin::run(&tracer, "pathtrace/caster/sphere_chain.wgsl", body, &[], &given);
        for item in 0..ITEMS {
            let chain = Chain { inverse_distance: chain(item).inverse_distance.max(0.01), ..chain(item) };
            let i = f64::from(incidence(item));
            let (ratio, expected) = (f64::from(f32::from_bits(on_gpu[item as usize][0])), ratio_of_rays(&chain, i));
            // in units of what the sphere would do that turned nothing
            let unit = 4.0 / (chain.inverse_distance * chain.inverse_distance) / i.cos();
            assert!(
                (ratio - expected).abs() < 2e-4 * expected + 2e-5 * unit,
                "{item}: {ratio} {expected} {chain:?} {i}"
            );
        }
    }
}
