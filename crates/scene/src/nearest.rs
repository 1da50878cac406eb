//! The name that a misspelt one was probably meant to be.

/// The known name that is nearest to `word` by insertions, deletions, replacements and swaps of letters, whatever their
/// case; `None` if none is near: every third letter may be wrong.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let small = word.to_lowercase();
    let distance = |name: &str| strsim::osa_distance(&small, &name.to_lowercase());
    let (name, mistakes) = known.into_iter().map(|name| (name, distance(name))).min_by_key(|(_, d)| *d)?;
    (3 * mistakes <= name.chars().count().max(3)).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

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
    }
}
