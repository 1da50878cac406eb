//! What paths find beyond their first vertices, written down as they go, for a guide to learn from.
//!
//! Each vertex of each path has a place of its own to write to, so that whatever traces them, and in whichever order,
//! leaves the same notes.

use super::cells::Cells;
use super::histogram::{BINS, COLUMNS, Finding, Histograms, ROWS};
use super::{Guide, bin};
use scene::Vec3;
use simd::{Float, MOST_LANES, Vector, Word};
use std::sync::atomic::{AtomicU64, Ordering};

/// Pixels along each side of the picture that a guide is learned from, whatever the picture's own size.
pub const SIDE: u32 = 128;
/// Its samples per pixel.
pub const SAMPLES: u32 = 8;
/// Vertices of a path that teach: of later ones too little is seen.
const VERTICES: usize = 4;

/// Words of a note.
const WORDS: usize = 3;

/// The notes of all paths.
pub struct Notes {
    cells: Cells,
    words: Vec<AtomicU64>,
}

impl Notes {
    /// Room for all paths' notes, with nothing noted yet.
    pub fn new(cells: Cells) -> Self {
        let count = (SIDE * SIDE * SAMPLES) as usize * VERTICES * WORDS;
        Notes { cells, words: std::iter::repeat_with(AtomicU64::default).take(count).collect() }
    }

    /// The bin of a direction from a point, which these numbers are warped to.
    #[inline(always)]
    pub fn place<F: Float>(&self, position: Vector<F>, normal: Vector<F>, u: [F; 2]) -> F::U {
        let cell = self.cells.of(position, normal).wrapping_mul(F::U::splat(BINS));
        let row = bin::<F, ROWS>(u[0]).wrapping_mul(F::U::splat(COLUMNS));
        cell.wrapping_add(row).wrapping_add(bin::<F, COLUMNS>(u[1]))
    }

    /// The guide that all these notes together teach.
    pub fn guide(&self) -> Guide {
        let mut histograms = Histograms::default();
        let notes = self.words.chunks_exact(WORDS);
        notes.filter_map(read).for_each(|finding| histograms.add(&finding));
        histograms.guide(self.cells)
    }
}

/// A number beside another in a word.
fn pair(low: u32, high: f32) -> u64 {
    u64::from(low) | u64::from(high.to_bits()) << 32
}

fn unpair(word: &AtomicU64) -> (u32, f32) {
    let word = word.load(Ordering::Relaxed);
    (word as u32, f32::from_bits((word >> 32) as u32))
}

/// No place has this number, but a note that was never written has.
const BLANK: u32 = 0;

fn write(words: &[AtomicU64], finding: &Finding) {
    let [x, y, z] = finding.expected.to_array();
    let found = finding.found.unwrap_or(f32::NAN);
    let note = [pair(finding.place + 1, found), pair(x.to_bits(), y), pair(z.to_bits(), 0.0)];
    for (word, value) in words.iter().zip(note) {
        word.store(value, Ordering::Relaxed);
    }
}

fn read(words: &[AtomicU64]) -> Option<Finding> {
    let [(place, found), (x, y), (z, _)] = [unpair(&words[0]), unpair(&words[1]), unpair(&words[2])];
    let expected = Vec3::new(f32::from_bits(x), y, f32::from_bits(z));
    (place != BLANK).then(|| Finding { place: place - 1, found: Some(found).filter(|f| !f.is_nan()), expected })
}

/// A vertex whose path is still under way.
#[derive(Clone, Copy, Default)]
struct Vertex {
    place: u32,
    /// What the path had brought home before it left.
    before: Vec3,
    /// What radiance from beyond is worth at the camera, had roulette not been played.
    carried: Vec3,
    /// What that became by roulette; 0 where it ended the path.
    survived: f32,
}

/// One turn of all lanes.
pub struct Turn {
    /// Lanes that have left a diffuse vertex, or that roulette ended there.
    pub left: u32,
    /// Lanes whose paths have ended.
    pub ended: u32,
    /// Bins of the directions.
    pub place: [u32; MOST_LANES],
    /// What the paths have brought home.
    pub radiance: [Vec3; MOST_LANES],
    /// Throughput before roulette, lane by lane.
    pub before: [Vec3; MOST_LANES],
    /// Throughput after it, of those that go on.
    pub after: [Vec3; MOST_LANES],
    /// Whose samples these are.
    pub pixel: [u32; MOST_LANES],
    /// Which samples of theirs.
    pub sample: [u32; MOST_LANES],
}

impl Turn {
    /// The state of lanes after a turn.
    #[inline(always)]
    pub fn numbers<U: Word>(of: U) -> [u32; MOST_LANES] {
        let mut numbers = [0; MOST_LANES];
        of.store(&mut numbers);
        numbers
    }
}

/// Writes notes for the paths in some lanes.
pub struct Recorder<'a> {
    notes: &'a Notes,
    vertices: [[Vertex; VERTICES]; MOST_LANES],
    count: [usize; MOST_LANES],
}

impl<'a> Recorder<'a> {
    /// Of paths that have not begun.
    pub fn new(notes: &'a Notes) -> Self {
        let vertices = [[Vertex::default(); VERTICES]; MOST_LANES];
        Recorder { notes, vertices, count: [0; MOST_LANES] }
    }

    /// Where they are written.
    #[inline(always)]
    pub fn notes(&self) -> &'a Notes {
        self.notes
    }

    /// Notes what a turn of all lanes has brought.
    #[inline(never)]
    pub fn note(&mut self, turn: &Turn) {
        let among = |bits: u32| (0..MOST_LANES).filter(move |lane| bits >> lane & 1 != 0);
        among(turn.left).for_each(|lane| self.leave(turn, lane));
        among(turn.ended).for_each(|lane| self.end(turn, lane));
    }

    fn leave(&mut self, turn: &Turn, lane: usize) {
        let Some(vertex) = self.vertices[lane].get_mut(self.count[lane]) else { return };
        self.count[lane] += 1;
        let (carried, after) = (turn.before[lane], turn.after[lane]);
        let survived = if turn.ended >> lane & 1 != 0 { 0.0 } else { after.max_element() / carried.max_element() };
        *vertex = Vertex { place: turn.place[lane], before: turn.radiance[lane], carried, survived };
    }

    fn end(&mut self, turn: &Turn, lane: usize) {
        let path = (turn.pixel[lane] * SAMPLES + turn.sample[lane]) as usize;
        let first = path * VERTICES * WORDS;
        let notes = self.notes.words[first..first + VERTICES * WORDS].chunks_exact(WORDS);
        for (vertex, words) in self.vertices[lane][..self.count[lane]].iter().zip(notes) {
            write(words, &vertex.finding(turn.radiance[lane]));
        }
        self.count[lane] = 0;
    }
}

impl Vertex {
    /// What was beyond it, by what the path has brought home in the end. A channel that the path no longer carries tells
    /// nothing and counts as dark.
    fn finding(&self, radiance: Vec3) -> Finding {
        let carries = self.carried.cmpgt(Vec3::ZERO);
        let expected = Vec3::select(carries, (radiance - self.before) / self.carried, Vec3::ZERO);
        let channels = carries.bitmask().count_ones().max(1) as f32;
        let found = (self.survived > 0.0).then(|| expected.element_sum() / (channels * self.survived));
        Finding { place: self.place, found, expected }
    }
}
