//! Which of its pixels' samples a film has: those of `--samples FROM..TO`, or of several such films together.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Numbers of samples, the first of all 0: parts of a row, in order, apart from each other and none empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SampleRanges(Vec<Range<u32>>);

impl SampleRanges {
    /// What an option or a record of them is.
    pub const EXPECTED: &str = "FROM..TO, numbers of samples from 0 on, TO above FROM and left out, like 0..64";

    /// The number of the first sample of all ranges.
    pub fn first(&self) -> u32 {
        self.0[0].start
    }

    /// How many samples a pixel has.
    pub fn count(&self) -> u32 {
        self.0.iter().map(|range| range.end - range.start).sum()
    }

    /// The numbers, where none is left out between them.
    pub fn without_gaps(&self) -> Option<Range<u32>> {
        if let [range] = &self.0[..] { Some(range.clone()) } else { None }
    }

    /// Whether they are those that `--spp` makes.
    pub fn are_the_first(&self) -> bool {
        self.without_gaps().is_some_and(|range| range.start == 0)
    }

    /// Both together; `None` if they have numbers in common.
    pub fn with(&self, others: &SampleRanges) -> Option<SampleRanges> {
        let mut all: Vec<Range<u32>> = self.0.iter().chain(&others.0).cloned().collect();
        all.sort_by_key(|range| range.start);
        if all.windows(2).any(|pair| pair[0].end > pair[1].start) {
            return None;
        }
        Some(SampleRanges(joined(all)))
    }

    /// The same in so many parts, one behind the other, as even as can be; fewer where there are fewer samples. `None`
    /// where they have gaps.
    pub fn split(&self, parts: u32) -> Option<Vec<SampleRanges>> {
        let Range { start, end } = self.without_gaps()?;
        let (count, parts) = (u64::from(end - start), u64::from(parts.clamp(1, end - start)));
        let begin = |part: u64| start + (count * part / parts) as u32;
        Some((0..parts).map(|part| (begin(part)..begin(part + 1)).into()).collect())
    }
}

/// Ranges in order, with those as one that follow each other.
fn joined(ranges: Vec<Range<u32>>) -> Vec<Range<u32>> {
    let mut joined: Vec<Range<u32>> = Vec::new();
    for range in ranges {
        match joined.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => joined.push(range),
        }
    }
    joined
}

impl From<Range<u32>> for SampleRanges {
    fn from(range: Range<u32>) -> Self {
        SampleRanges(vec![range])
    }
}

/// `0..8`, and with a gap `0..8,16..24`.
impl fmt::Display for SampleRanges {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let ranges = self.0.iter().map(|Range { start, end }| format!("{start}..{end}"));
        f.write_str(&ranges.collect::<Vec<_>>().join(","))
    }
}

impl FromStr for SampleRanges {
    type Err = &'static str;

    fn from_str(words: &str) -> Result<Self, Self::Err> {
        let range = |word: &str| {
            let (start, end) = word.split_once("..")?;
            let (start, end) = (start.trim().parse().ok()?, end.trim().parse().ok()?);
            (start < end).then(|| SampleRanges::from(start..end))
        };
        let ranges: Option<Vec<SampleRanges>> = words.split(',').map(range).collect();
        let all = ranges.into_iter().flatten().map(Some).reduce(|all, range| all?.with(&range?));
        all.flatten().ok_or(Self::EXPECTED)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranges(words: &str) -> SampleRanges {
        words.parse().expect(words)
    }

    #[test]
    fn ranges_are_told_as_they_are_read_in_order_and_joined() {
        for (words, told, count) in [
            ("0..64", "0..64", 64),
            ("7..8", "7..8", 1),
            ("16..24,0..8", "0..8,16..24", 16),
            ("8..16,0..8", "0..16", 16),
            ("0..4294967295", "0..4294967295", u32::MAX),
        ] {
            assert_eq!((ranges(words).to_string().as_str(), ranges(words).count()), (told, count));
        }
        for none in
            ["", "8", "8..", "..8", "8..8", "9..8", "0..8,", "-1..8", "0..8,7..9", "0..4294967296", "a..b", "0...8"]
        {
            assert_eq!(none.parse::<SampleRanges>(), Err(SampleRanges::EXPECTED), "{none}");
        }
    }

    #[test]
    fn ranges_with_a_sample_in_common_do_not_go_together() {
        let of = |a, b| ranges(a).with(&ranges(b)).map(|all| all.to_string());
        assert_eq!(of("0..8", "8..9").as_deref(), Some("0..9"));
        assert_eq!(of("4..5,10..12", "5..10").as_deref(), Some("4..12"));
        assert_eq!(of("4..5", "0..2").as_deref(), Some("0..2,4..5"));
        for (a, b) in [("0..8", "7..9"), ("0..8", "0..8"), ("0..9", "3..4"), ("0..2,4..6", "5..7")] {
            assert_eq!((of(a, b), of(b, a)), (None, None), "{a} {b}");
        }
    }

    #[test]
    fn those_from_the_first_on_are_told_from_others() {
        let of = |words| (ranges(words).are_the_first(), ranges(words).without_gaps().is_some(), ranges(words).first());
        assert_eq!(of("0..8"), (true, true, 0));
        assert_eq!(of("1..8"), (false, true, 1));
        assert_eq!(of("0..8,9..10"), (false, false, 0));
    }

    #[test]
    fn parts_follow_each_other_and_hold_all() {
        let parts = |words, parts| {
            let parts: Option<Vec<_>> = ranges(words).split(parts);
            parts.map(|parts| parts.iter().map(ToString::to_string).collect::<Vec<_>>())
        };
        let told = |words: &[&str]| Some(words.iter().map(ToString::to_string).collect());
        assert_eq!(parts("0..10", 3), told(&["0..3", "3..6", "6..10"]));
        assert_eq!(parts("5..7", 9), told(&["5..6", "6..7"]));
        assert_eq!(parts("0..4294967295", 1), told(&["0..4294967295"]));
        assert_eq!(parts("0..1,2..3", 2), None);
    }
}
