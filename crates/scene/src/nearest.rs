//! The name that a misspelt one was probably meant to be.

/// The known name that is nearest to `word` by insertions, deletions, replacements and swaps of letters, whatever their
/// case; `None` if none is near: every third letter may be wrong.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let small = word.to_lowercase();
    let distance = |name: &str| strsim::osa_distance(&small, &name.to_lowercase());
    let known: Vec<(&str, usize)> = known.into_iter().map(|name| (name, distance(name))).collect();
    let (name, mistakes) = known.iter().copied().min_by_key(|(_, mistakes)| *mistakes)?;
    let others = known.iter().filter(|(other, equal)| *equal == mistakes && *other != name).count();
    let letters = name.chars().count();
    // of short names several are one letter away
    let is_clear = mistakes == 0 || letters > 3 || others == 0;
    (is_clear && mistakes < letters && 3 * mistakes <= letters.max(3)).then_some(name)
}

/// The nearest, or else the only known name that begins as `word` does: with all of the shorter of the two, or with
/// four letters.
pub fn nearest_or_begun<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let (small, known) = (word.to_lowercase(), known.into_iter().collect::<Vec<_>>());
    let begun = || {
        let alike = |name: &str| small.chars().zip(name.to_lowercase().chars()).take_while(|(a, b)| a == b).count();
        let enough = |name: &str| name.chars().count().min(small.chars().count()).clamp(3, 4);
        let mut begun = known.iter().filter(|name| alike(name) >= enough(name));
        begun.next().filter(|_| begun.next().is_none()).copied()
    };
    nearest(word, known.iter().copied()).or_else(begun)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_begins_as_one_name_alone_does_may_mean_it() {
        let known = ["a", "side", "wipe", "sampler", "sun-radius", "sun-size"];
        for (word, meant) in [
            ("A", Some("a")),
            ("side-by-side", Some("side")),
            ("sampp", Some("sampler")),
            ("samples", Some("sampler")),
            ("sun", None),
            ("an", None),
            ("wi", None),
            ("", None),
        ] {
            assert_eq!(nearest_or_begun(word, known), meant, "{word}");
        }
    }

    #[test]
    fn a_slip_is_understood_and_another_word_is_not() {
        let known = ["center", "radius", "material", "box"];
        for (word, meant) in [
            ("centre", Some("center")),
            ("Radius", Some("radius")),
            ("radios", Some("radius")),
            ("materiel", Some("material")),
            ("bx", Some("box")),
            ("colour", None),
            ("", None),
            ("mat", None),
        ] {
            assert_eq!(nearest(word, known), meant, "{word}");
        }
        assert_eq!(nearest("radius", []), None);
        assert_eq!(nearest("2e", ["1a", "2b", "2c"]), None, "two are as near");
        assert_eq!(nearest("x", ["a", "b"]), None, "nothing of it is left");
    }
}
