//! Names beside the lines' ends, none over another: each as near to its line as its neighbours leave it.

use super::{Frame, Series, TOP, TYPE, line, mark, text};

/// From one name's baseline to the next.
const PITCH: f64 = TYPE * 1.4;
/// From the plot's edge to the sample of a line, and on to its name.
const LEADER: f64 = 34.0;
const SAMPLE: f64 = 40.0;

/// Characters of a name that have room; of a longer one the rest is left out.
const MOST_CHARACTERS: usize = 36;

/// Draws the names of lines whose last points are at these heights.
pub fn draw(svg: &mut String, mut named: Vec<(&Series, f64)>) {
    named.sort_by(|a, b| a.1.total_cmp(&b.1));
    let wishes: Vec<f64> = named.iter().map(|(_, y)| *y).collect();
    for ((series, wish), at) in named.into_iter().zip(spread(&wishes, PITCH, (TOP, Frame::BOTTOM))) {
        let colour = series.colour();
        let begin = Frame::RIGHT + LEADER;
        line(svg, (Frame::RIGHT + 4.0, wish), (begin - 3.0, at), "#b0b0b0", "");
        line(svg, (begin, at), (begin + SAMPLE, at), colour, series.stroke.style());
        mark(svg, series.stroke, (begin + 0.5 * SAMPLE, at), colour, colour);
        text(svg, (begin + SAMPLE + 8.0, at + 0.35 * TYPE), "start", "", &shortened(&series.name));
    }
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= MOST_CHARACTERS {
        return name.to_owned();
    }
    name.chars().take(MOST_CHARACTERS - 1).chain(['…']).collect()
}

/// Ascending heights at least `pitch` apart, near to the ascending wishes and within the bounds where there is room:
/// names that collide form a block about the mean of their wishes.
fn spread(wishes: &[f64], pitch: f64, (low, high): (f64, f64)) -> Vec<f64> {
    // (first wish's place, how many)
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    for &wish in wishes {
        let mut block = (wish, 1);
        loop {
            let lowest = high - (block.1 - 1) as f64 * pitch;
            block.0 = block.0.min(lowest).max(low);
            let Some((above, count)) = blocks.pop_if(|(above, count)| *above + *count as f64 * pitch > block.0) else {
                break;
            };
            let (m, n) = (count as f64, block.1 as f64);
            // the block that is joined begins `count` places further down
            block = ((m * above + n * (block.0 - m * pitch)) / (m + n), count + block.1);
        }
        blocks.push(block);
    }
    let places = |(start, count): &(f64, usize)| {
        let start = *start;
        (0..*count).map(move |i| start + i as f64 * pitch)
    };
    blocks.iter().flat_map(places).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_is_cut() {
        assert_eq!(shortened("short"), "short");
        assert_eq!(shortened(&"é".repeat(50)).chars().count(), MOST_CHARACTERS);
    }

    #[test]
    fn names_keep_their_places_where_there_is_room() {
        assert_eq!(spread(&[10.0, 50.0, 90.0], 20.0, (0.0, 100.0)), [10.0, 50.0, 90.0]);
    }

    #[test]
    fn names_that_collide_stand_about_their_middle() {
        assert_eq!(spread(&[50.0, 50.0, 50.0], 20.0, (0.0, 100.0)), [30.0, 50.0, 70.0]);
        assert_eq!(spread(&[95.0, 99.0], 20.0, (0.0, 100.0)), [80.0, 100.0]);
        assert_eq!(spread(&[1.0, 2.0], 20.0, (0.0, 100.0)), [0.0, 20.0]);
    }

    #[test]
    fn no_two_names_overlap_whatever_they_wish() {
        let mut wish = 7u32;
        let mut wishes: Vec<f64> = Vec::new();
        for _ in 0..200 {
            wish = wish.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            wishes.push(f64::from(wish >> 16) % 500.0);
            if wishes.len() > 14 {
                wishes.remove(0);
            }
            let mut sorted = wishes.clone();
            sorted.sort_by(f64::total_cmp);
            let at = spread(&sorted, 28.0, (0.0, 500.0));
            assert!(at.windows(2).all(|pair| pair[1] - pair[0] > 27.999), "{sorted:?} {at:?}");
            assert!(at.iter().all(|at| (0.0..=500.001).contains(at)), "{at:?}");
        }
    }
}
