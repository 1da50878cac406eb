//! Numbers that are not written as TOML writes them.

use super::place::Place;
use film::colour::srgb_decode;

/// A number as TOML has it: digits on both sides of the point, and none that is 0 before the others.
pub(super) fn number(word: &str) -> Option<String> {
    let word = word.trim();
    let value: f64 = word.parse().ok().filter(|value: &f64| value.is_finite())?;
    let (sign, digits) = match word.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", word.strip_prefix('+').unwrap_or(word)),
    };
    if digits.contains(['e', 'E']) {
        return Some(format!("{value}"));
    }
    let filled = |digits: &str| if digits.is_empty() { "0".to_owned() } else { digits.to_owned() };
    let (whole, part) = digits.split_once('.').map_or((digits, None), |(whole, part)| (whole, Some(part)));
    let whole = filled(whole.trim_start_matches('0'));
    Some(part.map_or(format!("{sign}{whole}"), |part| format!("{sign}{whole}.{}", filled(part))))
}

/// The least code of a screen's colour that is told from a number that is too large: nobody sees darker ones.
const DARKEST: u8 = 9;

/// "0,5": what is before the comma and behind it.
fn with_a_comma(word: &str) -> Option<(&str, &str)> {
    let (whole, part) = word.split_once(',')?;
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    (digits(whole.trim_start_matches(['-', '+'])) && digits(part)).then_some((whole, part))
}

fn write_with_a_point((whole, part): (&str, &str)) -> String {
    let thousands = part.len() == 3 && !whole.trim_start_matches(['-', '+']).starts_with('0');
    if thousands {
        return format!("numbers have a decimal point and no commas: write {whole}.{part}, or {whole}{part}");
    }
    format!("numbers have a decimal point: write {whole}.{part}, not {whole},{part}")
}

impl Place<'_> {
    /// 0,5 for 0.5 as the value of a name.
    pub fn decimal_comma(&self) -> Option<String> {
        let (_, value) = self.assignment()?;
        let word = value.split(|c: char| c.is_whitespace() || "}])#".contains(c)).next()?;
        with_a_comma(word.trim_end_matches([',', ';'])).map(write_with_a_point)
    }

    /// The same in a list of twice three numbers, or of three words with spaces between them.
    pub fn decimal_comma_in_a_list(&self, message: &str) -> Option<String> {
        let list = self.list().filter(|_| message.contains("is not a") || message.contains("found one of"))?;
        let spaced: Vec<&str> = list.split([' ', '\n', '\t']).map(|word| word.trim_matches(',')).collect();
        let spaced: Vec<&str> = spaced.into_iter().filter(|word| !word.is_empty()).collect();
        let fits = |word: &&str| number(word).is_some() || with_a_comma(word).is_some();
        let by_words = || spaced.iter().find_map(|word| with_a_comma(word));
        let found = if spaced.len() == 3 && spaced.iter().all(fits) {
            by_words()
        } else {
            let first = list.match_indices(',').nth(1).map(|(end, _)| list[..end].trim());
            first.filter(|_| list.matches(',').count() == 5).and_then(with_a_comma)
        };
        found.map(write_with_a_point)
    }

    /// 0, 1, 0 for [0, 1, 0].
    pub fn list_without_brackets(&self) -> Option<String> {
        let (_, value) = self.assignment()?;
        let words = value.split(['#', '}']).next()?.split(',');
        let numbers: Vec<String> = words.map_while(number).collect();
        (numbers.len() == 3).then(|| format!("a list stands in square brackets: [{}]", numbers.join(", ")))
    }

    /// 1 000 for 1000, or numbers of a list without the commas.
    pub fn numbers_with_spaces(&self, value: &str) -> Option<String> {
        let words: Vec<&str> = value.split_whitespace().collect();
        let numbers: Vec<String> = words.iter().map(|word| number(word)).collect::<Option<_>>()?;
        let (first, rest) = words.split_first().filter(|(_, rest)| !rest.is_empty())?;
        let of_three = |word: &&str| word.len() == 3 && word.chars().all(|c| c.is_ascii_digit());
        let grouped = rest.iter().all(of_three) && !first.contains('.');
        match (self.list(), numbers.len()) {
            (list, count) if grouped && (rest.iter().any(|w| w.starts_with('0')) || list.is_none() && count == 2) => {
                Some(format!("a number has no spaces: write {}", words.concat()))
            }
            (Some(_), _) => Some(format!("a list has commas: write {}", numbers.join(", "))),
            (None, 3) => Some(format!("a list has commas and square brackets: write [{}]", numbers.join(", "))),
            (None, _) => None,
        }
    }

    /// A colour from 0 to 255, as pickers on screens say it, by its numbers or in hexadecimal.
    pub fn screen_colour(&self, message: &str) -> Option<String> {
        let codes = if message.contains("is not a number from 0 to 1") {
            let codes = self.list()?.split(',').map(|word| word.trim().parse().ok()).collect::<Option<Vec<u8>>>()?;
            codes.iter().any(|code| *code > DARKEST).then_some(codes)?
        } else {
            let (hex, _) = message.strip_prefix("invalid type: string \"#")?.split_once('"')?;
            let code = |i| u8::from_str_radix(hex.get(i..i + 2)?, 16).ok();
            [0, 2, 4].into_iter().map(code).collect::<Option<Vec<u8>>>().filter(|_| hex.len() == 6)?
        };
        let [r, g, b] = codes[..] else { return None };
        let linear = [r, g, b].map(|code| (1000.0 * srgb_decode(f32::from(code) / 255.0)).round() / 1000.0);
        Some(format!("colours here are linear, from 0 to 1: what a screen calls {r}, {g}, {b} is {linear:?}"))
    }

    /// .5 and 5. are no numbers of TOML; the parser's place is before the one and behind the other.
    pub fn bare_point(&self, message: &str) -> Option<String> {
        let value = self.line().split_once('=').filter(|_| message.ends_with(", expected digits"))?.1;
        let words = value.split(|c: char| c.is_whitespace() || "[],{}#".contains(c));
        let is_bare = |word: &str| word.trim_start_matches(['-', '+']).starts_with('.') || word.ends_with('.');
        let filled = words.filter(|word| is_bare(word)).find_map(number)?;
        Some(format!("write {filled}"))
    }
}

pub(super) fn number_in_quotes(message: &str) -> Option<String> {
    let (word, expected) = message.strip_prefix("invalid type: string \"")?.split_once('"')?;
    let number =
        number(&word.replacen(',', ".", 1)).filter(|_| expected.contains("number") && !expected.contains("list"))?;
    Some(format!("a number has no quotes: write {number}"))
}

/// A quotient, or a number with a unit.
pub(super) fn no_number(value: &str) -> Option<String> {
    if let Some((above, below)) = value.split_once('/') {
        let quotient = above.trim().parse::<f32>().ok()? / below.trim().parse::<f32>().ok()?;
        return quotient.is_finite().then(|| format!("a file does not calculate: write {quotient}"));
    }
    let unit = value.find(|c: char| c.is_alphabetic() || "°%".contains(c))?;
    let alone = number(&value[..unit])?;
    let percent = value[unit..].starts_with('%').then(|| alone.parse::<f32>().ok()).flatten();
    let alone = percent.map_or(alone, |percent| (percent / 100.0).to_string());
    Some(format!("a number stands alone: write {alone}"))
}
