//! Every operation of every backend against plain `f32`, `u32` and `f64`, on values where they like to differ.

use simd::{BitMatrix, Column, Double, Float, Kernel, Lanes, MOST_LANES, Mask, Vector, Word, WordColumn};

/// Zeros, subnormals, halves, large and infinite numbers, NaN.
const EDGES: [f32; 24] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    2.5,
    -2.5,
    1e-40,
    -1e-45,
    f32::MIN_POSITIVE,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    3.3,
    -1e10,
    16_777_216.0,
    8_388_607.5,
    -0.999_999_94,
    1.000_000_1,
    1e-20,
];

/// A name, and the bits of its results in order of the operands.
type Results = Vec<(&'static str, Vec<u64>)>;

struct Everything {
    a: Vec<f32>,
    b: Vec<f32>,
}

static MATRIX: BitMatrix = {
    let mut columns = [0; 32];
    let mut i = 0;
    while i < 32 {
        columns[i] = 0x9e37_79b9u32.wrapping_mul(2 * i as u32 + 1);
        i += 1;
    }
    BitMatrix::new(&columns)
};

/// NaNs are one value here: which one comes out is the machine's choice.
fn bits(value: f32) -> u64 {
    u64::from(if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() })
}

struct Log {
    results: Results,
    next: usize,
}

impl Log {
    fn push(&mut self, name: &'static str, values: impl IntoIterator<Item = u64>) {
        if self.next == self.results.len() {
            self.results.push((name, Vec::new()));
        }
        self.results[self.next].1.extend(values);
        self.next += 1;
    }

    fn float<F: Float>(&mut self, name: &'static str, value: F) {
        let mut lanes = [0.0; MOST_LANES];
        value.store(&mut lanes);
        self.push(name, lanes[..F::LANES].iter().map(|&v| bits(v)));
    }

    fn word<F: Float>(&mut self, name: &'static str, value: F::U) {
        let mut lanes = [0; MOST_LANES];
        value.store(&mut lanes);
        self.push(name, lanes[..F::LANES].iter().map(|&v| u64::from(v)));
    }

    fn mask<F: Float>(&mut self, name: &'static str, value: F::M) {
        assert_eq!(value.any(), value.bits() != 0);
        assert_eq!(value.count(), value.bits().count_ones());
        assert_eq!(F::M::from_bits(value.bits()).bits(), value.bits());
        self.push(name, (0..F::LANES).map(|i| u64::from(value.bits() >> i & 1)));
    }
}

impl Kernel for Everything {
    type Output = Results;

    #[inline(always)]
    fn run<F: Float>(self) -> Results {
        let mut log = Log { results: Vec::new(), next: 0 };
        let small = Column::new((0..20).map(|i| i as f32 * 0.7));
        let large = Column::new((0..100).map(|i| i as f32 * 0.3));
        let words = [WordColumn::new((0..20).map(|i| i * 77)), WordColumn::new((0..100).map(|i| i * 13))];
        for (a, b) in self.a.chunks(F::LANES).zip(self.b.chunks(F::LANES)) {
            log.next = 0;
            floats::<F>(&mut log, F::load(a), F::load(b));
            let [u, v] = [F::load(a), F::load(b)].map(F::to_bits);
            words_of::<F>(&mut log, u, v);
            let place = u.shr::<21>();
            let within = |most: u32| F::U::select(place.lt(F::U::splat(most)), place, place & F::U::splat(15));
            log.float("look up few", within(20).look_up(&small));
            log.float("look up many", within(100).look_up(&large));
            log.word::<F>("look up few words", within(20).look_up_word(&words[0]));
            log.word::<F>("look up many words", within(100).look_up_word(&words[1]));
        }
        log.results
    }
}

#[inline(always)]
fn floats<F: Float>(log: &mut Log, a: F, b: F) {
    log.float("add", a + b);
    log.float("subtract", a - b);
    log.float("multiply", a * b);
    log.float("divide", a / b);
    log.float("no fusing", a * b + a);
    log.float("numbers", ((a + 0.3) * 1.7 - 0.1) / 3.0);
    log.float("negate", -a);
    log.float("min", a.min(b));
    log.float("max", a.max(b));
    log.float("abs", a.abs());
    log.float("sqrt", a.sqrt());
    log.float("floor", a.floor());
    log.float("ceil", a.ceil());
    log.float("round", a.round());
    log.float("copysign", a.copysign(b));
    log.float("clamp", a.clamp(F::splat(-1.0), F::splat(2.0)));
    let finite = F::select(a.is_finite(), a, F::splat(1.0));
    log.float("next up", finite.next_up());
    log.float("next down", finite.next_down());
    log.float("select", F::select(a.lt(b), a, b));
    log.mask::<F>("lt", a.lt(b));
    log.mask::<F>("le", a.le(b));
    log.mask::<F>("gt", a.gt(b));
    log.mask::<F>("ge", a.ge(b));
    log.mask::<F>("eq", a.eq(b));
    log.mask::<F>("finite", a.is_finite());
    log.mask::<F>("not, and, or, xor", (!a.lt(b) & a.le(b)) | (a.eq(b) ^ F::M::splat(true)));
    let countable = F::select(a.abs().lt(F::splat(2e9)), a.abs(), F::splat(7.9));
    log.word::<F>("to word", countable.to_word());
    let (c, d) = (a.widen(), b.widen());
    log.float("double add", (c + d).narrow());
    log.float("double subtract", (c - d).narrow());
    log.float("double multiply", (c * d + c).narrow());
    log.float("double divide", (c / d).narrow());
    log.float("double sqrt", c.sqrt().narrow());
    log.float("double numbers", ((c + 0.3) * 1.7 - 0.1).narrow());
    log.float("double splat", F::D::splat(0.1).narrow());
    log.mask::<F>("double lt", c.lt(d));
    log.float("vector", Vector::new(a, b, a + b).normalize().max_element());
}

#[inline(always)]
fn words_of<F: Float>(log: &mut Log, u: F::U, v: F::U) {
    log.word::<F>("word and, or, xor, not", (u & v) ^ !(u | v));
    log.word::<F>("word add", u.wrapping_add(v));
    log.word::<F>("word subtract", u.wrapping_sub(v));
    log.word::<F>("word multiply", u.wrapping_mul(v));
    log.word::<F>("shl", u.shl::<5>());
    log.word::<F>("shr", u.shr::<7>());
    log.word::<F>("reverse", u.reverse_bits());
    log.word::<F>("word select", F::U::select(u.lt(v), u, v));
    log.mask::<F>("word eq", u.eq(v));
    log.mask::<F>("word lt", u.lt(v));
    log.float("to float", u.shr::<1>().to_float());
    log.word::<F>("matrix", u.multiplied_by(&MATRIX));
}

/// The scalar backend calls Rust's own operations; these are checked for what is our own in them.
#[test]
fn one_lane_is_plain_arithmetic() {
    for &a in &EDGES {
        if a.is_finite() {
            assert_eq!(Float::next_up(a).to_bits(), a.next_up().to_bits(), "{a}");
            assert_eq!(Float::next_down(a).to_bits(), a.next_down().to_bits(), "{a}");
        }
        assert_eq!(Float::is_finite(a), a.is_finite());
        for &b in &EDGES {
            assert_eq!(Float::copysign(a, b).to_bits(), a.copysign(b).to_bits());
        }
    }
    let slowly = |factor: u32| (0..32).filter(|i| factor >> i & 1 == 1).fold(0, |p, i| p ^ MATRIX.times(1 << i));
    for factor in [0, 1, 0xffff_ffff, 0x1234_5678] {
        assert_eq!(MATRIX.times(factor), slowly(factor));
    }
}

#[test]
fn all_backends_give_the_same_bits() {
    let pairs = || EDGES.iter().flat_map(|&a| EDGES.iter().map(move |&b| (a, b)));
    let random = (0..4096u32).map(|i| {
        let hash = |x: u32| x.wrapping_mul(0x9e37_79b9) ^ x.wrapping_mul(0x85eb_ca6b) >> 13;
        (f32::from_bits(hash(i)), f32::from_bits(hash(i + 77_777)))
    });
    let (a, b): (Vec<f32>, Vec<f32>) = pairs().chain(random).unzip();
    assert_eq!(a.len() % MOST_LANES, 0);
    let results = |lanes: Lanes| lanes.run(Everything { a: a.clone(), b: b.clone() });
    let expected = results(Lanes::Scalar);
    assert!(Lanes::available().count() >= 2);
    for lanes in Lanes::available() {
        for ((name, got), (_, expected)) in results(lanes).iter().zip(&expected) {
            assert_eq!(got.len(), expected.len());
            for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
                assert_eq!(got, expected, "{} of {} and {} on {}", name, a[i], b[i], lanes.name());
            }
        }
    }
}

/// The rounding of the product is all that may be missing: half a step of it, and of the sum.
#[test]
fn a_product_and_a_sum_are_as_near_as_two_roundings() {
    struct MulAdd<'a>([&'a [f32]; 3]);
    impl Kernel for MulAdd<'_> {
        type Output = Vec<f32>;

        #[inline(always)]
        fn run<F: Float>(self) -> Vec<f32> {
            let mut results = vec![0.0; self.0[0].len()];
            for start in (0..results.len()).step_by(F::LANES) {
                let [a, b, c] = self.0.map(|values| F::load(&values[start..]));
                a.mul_add(b, c).store(&mut results[start..]);
            }
            results
        }
    }
    let values =
        |seed: u32| (0..256u32).map(|i| (i.wrapping_mul(0x9e37_79b9) ^ seed) as f32 / 2e9 - 1.0).collect::<Vec<_>>();
    let [a, b, c] = [1, 0x5555, 0x1234_5678].map(values);
    for lanes in Lanes::available() {
        for (i, got) in lanes.run(MulAdd([&a, &b, &c])).into_iter().enumerate() {
            let [a, b, c] = [a[i], b[i], c[i]].map(f64::from);
            let bound = f64::from(f32::EPSILON) * ((a * b).abs() + (a * b + c).abs());
            assert!((f64::from(got) - (a * b + c)).abs() <= bound, "{a} {b} {c} on {}: {got}", lanes.name());
        }
    }
}

#[test]
fn names_are_read_back() {
    assert!(Lanes::ALL.iter().all(|&lanes| Lanes::named(lanes.name()) == Some(lanes)));
    assert_eq!(Lanes::named("sse2"), None);
}
