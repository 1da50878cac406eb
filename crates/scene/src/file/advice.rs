//! What a beginner is told beside the TOML parser's own words: what was probably meant, and how that is written.

use crate::nearest;
use film::colour::srgb_decode;
use std::ops::Range;

/// The parser's message about this place of the text, with the cure if the mistake is a usual one.
pub(super) fn advised(text: &str, at: Range<usize>, message: String) -> String {
    let place = Place { text, at };
    let written = place.rest_of_line();
    if let Some(cure) = place.brackets(&message).or_else(|| unknown_field(&message)) {
        return cure;
    }
    let cure = place
        .decimal_comma(&message)
        .or_else(|| place.screen_colour(&message))
        .or_else(|| number_in_quotes(&message))
        .or_else(|| value_without_quotes(&message, written))
        .or_else(|| place.parentheses(&message))
        .or_else(|| bare_point(&message, place.line()))
        .or_else(|| place.stated_twice(&message))
        .or_else(|| place.missing_field(&message));
    cure.map_or(message.clone(), |cure| format!("{message}; {cure}"))
}

/// A shape wears a material that there is not.
pub(super) fn unknown_material(name: &str, known: &[&str]) -> String {
    let there = match (nearest(name, known.iter().copied()), known) {
        (_, []) => format!("the file has none; add [material.{name}] with diffuse = {{ albedo = [0.5, 0.5, 0.5] }}"),
        (Some(near), _) => format!("the file has {}; did you mean '{near}'?", known.join(", ")),
        (None, _) => format!("the file has {}", known.join(", ")),
    };
    format!("no material is called '{name}': {there}")
}

/// Words of other programs and formats, and what they are called here.
const ELSEWHERE: [(&str, &str); 24] = [
    ("spheres", "sphere"),
    ("ball", "sphere"),
    ("quad", "rectangle"),
    ("plane", "rectangle"),
    ("cube", "box"),
    ("triangles", "mesh"),
    ("light", "point_light"),
    ("lights", "point_light"),
    ("environment", "sky"),
    ("background", "sky"),
    ("color", "diffuse"),
    ("colour", "diffuse"),
    ("lambert", "diffuse"),
    ("glass", "dielectric"),
    ("metal", "rough_conductor"),
    ("emission", "emissive"),
    ("light_color", "radiance"),
    ("position", "eye"),
    ("origin", "eye"),
    ("look_at", "target"),
    ("lookat", "target"),
    ("fov", "fov_y"),
    ("rotation", "turn_y"),
    ("direction", "towards"),
];

/// "unknown field `a`, expected one of `b`, `c`", with what was meant.
fn unknown_field(message: &str) -> Option<String> {
    let rest = message.strip_prefix("unknown field `")?;
    let (word, expected) = rest.split_once("`, expected ")?;
    let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    let elsewhere = ELSEWHERE.iter().filter(|(name, _)| name.eq_ignore_ascii_case(word)).map(|(_, here)| *here);
    let meant = nearest(word, known.iter().copied()).or_else(|| elsewhere.into_iter().find(|w| known.contains(w)));
    let cure = match meant {
        Some(name) => format!("did you mean `{name}`?"),
        // the scene itself: a material that stands among its tables
        None if known.contains(&"material") && known.contains(&"camera") => {
            format!("a material of this name is [material.{word}]")
        }
        None => return None,
    };
    Some(format!("{message}; {cure}"))
}

/// A place of a text.
struct Place<'a> {
    text: &'a str,
    at: Range<usize>,
}

impl<'a> Place<'a> {
    fn before(&self) -> &'a str {
        self.text.get(..self.at.start).unwrap_or_default()
    }

    fn after(&self) -> &'a str {
        self.text.get(self.at.start..).unwrap_or_default()
    }

    fn rest_of_line(&self) -> &'a str {
        self.after().lines().next().unwrap_or_default().trim()
    }

    fn line(&self) -> &'a str {
        let start = self.before().rfind('\n').map_or(0, |end| end + 1);
        self.text.get(start..).unwrap_or_default().lines().next().unwrap_or_default()
    }

    /// The list of values without lists in it that begins here, or that this place is in.
    fn list(&self) -> Option<&'a str> {
        let start = match self.after().starts_with('[') {
            true => self.at.start,
            false => self.before().rfind('[')?,
        };
        let list = self.text.get(start + 1..)?;
        list.get(..list.find(']')?).filter(|list| start + 1 + list.len() >= self.at.start)
    }

    /// One table where there is a list of them, and the other way round.
    fn brackets(&self, message: &str) -> Option<String> {
        let name = |header: &'a str| header.split([']', '[']).find(|part| !part.is_empty());
        if message == "invalid type: map, expected a sequence" {
            let header = name(self.line().trim().strip_prefix('[')?)?;
            return Some(format!("a scene has a list of these: write [[{header}]], in double brackets"));
        }
        let doubled = message == "invalid type: sequence, expected a table of names and values";
        let header = name(self.after().strip_prefix("[[").filter(|_| doubled)?)?;
        Some(format!("{message}; there is one such table: write [{header}], in single brackets"))
    }

    /// 0,5 for 0.5, by itself, or in a list of twice three numbers or with other commas that are spaced.
    fn decimal_comma(&self, message: &str) -> Option<String> {
        let alone = self.after().starts_with(',').then(|| self.before().len());
        let in_a_list = || {
            let list = self.list().filter(|_| message.contains("is not a") || message.contains("found one of"))?;
            let commas = list.matches(',').count();
            let at = list.match_indices(',').map(|(at, _)| at).find(|at| is_in_a_number(list, *at))?;
            (commas == 5 || list.contains(", ")).then_some((list, at))
        };
        let alone = alone.filter(|at| is_in_a_number(self.text, *at)).map(|at| (self.text, at));
        let (text, at) = alone.or_else(in_a_list)?;
        let numeric = |c: char| c.is_ascii_digit() || c == '-';
        let whole = &text[text[..at].rfind(|c| !numeric(c)).map_or(0, |end| end + 1)..at];
        let rest = &text[at + 1..];
        let part = &rest[..rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())];
        Some(format!("numbers have a decimal point: write {whole}.{part}, not {whole},{part}"))
    }

    /// A colour from 0 to 255, as pickers on screens say it, by its numbers or in hexadecimal.
    fn screen_colour(&self, message: &str) -> Option<String> {
        let codes = if message.contains("is not a number from 0 to 1") {
            let codes = self.list()?.split(',').map(|word| word.trim().parse().ok()).collect::<Option<Vec<u8>>>()?;
            codes.iter().any(|code| *code > 1).then_some(codes)?
        } else {
            let (hex, _) = message.strip_prefix("invalid type: string \"#")?.split_once('"')?;
            let code = |i| u8::from_str_radix(hex.get(i..i + 2)?, 16).ok();
            [0, 2, 4].into_iter().map(code).collect::<Option<Vec<u8>>>().filter(|_| hex.len() == 6)?
        };
        let [r, g, b] = codes[..] else { return None };
        let linear = [r, g, b].map(|code| (1000.0 * srgb_decode(f32::from(code) / 255.0)).round() / 1000.0);
        Some(format!("colours here are linear, from 0 to 1: what a screen calls {r}, {g}, {b} is {linear:?}"))
    }

    fn parentheses(&self, message: &str) -> Option<String> {
        let (_, value) = self.line().split_once('=').filter(|_| message.starts_with("unexpected key or value"))?;
        let inside = value.trim().strip_prefix('(')?.split(')').next()?;
        Some(format!("a list stands in square brackets: [{inside}]"))
    }

    fn stated_twice(&self, message: &str) -> Option<String> {
        let header = self.line().trim().strip_prefix('[').filter(|_| message == "duplicate key")?;
        let name = header.split(']').next()?;
        Some(match name {
            "sphere" | "rectangle" | "disk" | "box" | "mesh" | "point_light" => {
                format!("a scene has a list of these: write each as [[{name}]], in double brackets")
            }
            name => format!("there is one [{name}]: put all of it under one header"),
        })
    }

    fn missing_field(&self, message: &str) -> Option<String> {
        let field = message.strip_prefix("missing field `")?.strip_suffix('`')?;
        match field {
            "camera" => Some("a scene begins with [camera] and its eye, target and fov_y".into()),
            "material" => {
                let text: toml::Table = self.text.parse().ok()?;
                let names = text.get("material")?.as_table()?.keys().map(String::as_str).collect::<Vec<_>>();
                Some(format!("say which it wears, like material = \"{}\"", names.first()?))
            }
            _ => None,
        }
    }
}

/// Whether the comma at `at` stands between two digits.
fn is_in_a_number(text: &str, at: usize) -> bool {
    text[..at].ends_with(|c: char| c.is_ascii_digit()) && text[at + 1..].starts_with(|c: char| c.is_ascii_digit())
}

fn number_in_quotes(message: &str) -> Option<String> {
    let (word, _) = message.strip_prefix("invalid type: string \"")?.split_once('"')?;
    let number = word.trim().replace(',', ".");
    number.parse::<f32>().ok().map(|_| format!("a number has no quotes: write {number}"))
}

/// What stands where a value is expected, and is neither a number nor in quotes.
fn value_without_quotes(message: &str, written: &str) -> Option<String> {
    if !message.starts_with("string values must be quoted") {
        return None;
    }
    if written.contains("//") || written.contains("/*") {
        return Some("a remark begins with #".into());
    }
    let value = written.split([',', ']', '}', '#']).next().unwrap_or_default().trim();
    let cure = numbers_without_commas(value)
        .or_else(|| value.strip_suffix(';').map(|value| format!("a value ends with its line: write {value}")))
        .or_else(|| quotient(value).map(|value| format!("a file does not calculate: write {value}")))
        .or_else(|| number_with_unit(value).map(|number| format!("a number stands alone: write {number}")));
    cure.or_else(|| match value.to_lowercase().as_str() {
        word @ ("true" | "false") => Some(format!("write {word}")),
        _ => value.starts_with(|c: char| c.is_alphabetic()).then(|| format!("write \"{value}\"")),
    })
}

fn is_number(word: &str) -> bool {
    word.parse::<f32>().is_ok()
}

fn numbers_without_commas(value: &str) -> Option<String> {
    let words: Vec<&str> = value.split_whitespace().collect();
    let numbers = words.len() > 1 && words.iter().all(|word| is_number(word));
    numbers.then(|| format!("a list has commas: write {}", words.join(", ")))
}

fn quotient(value: &str) -> Option<f32> {
    let (above, below) = value.split_once('/')?;
    Some(above.trim().parse::<f32>().ok()? / below.trim().parse::<f32>().ok()?)
}

fn number_with_unit(value: &str) -> Option<&str> {
    let number = &value[..value.find(|c: char| c.is_alphabetic() || "°%".contains(c))?];
    is_number(number.trim()).then_some(number)
}

/// .5 and 5. are no numbers of TOML; the parser's place is before the one and behind the other.
fn bare_point(message: &str, line: &str) -> Option<String> {
    let value = line.split_once('=').filter(|_| message.ends_with(", expected digits"))?.1;
    let words = value.split(|c: char| c.is_whitespace() || "[],{}#".contains(c));
    let is_bare =
        |word: &&str| is_number(word) && (word.trim_start_matches(['-', '+']).starts_with('.') || word.ends_with('.'));
    let (whole, part) = words.into_iter().find(is_bare)?.split_once('.')?;
    let filled = |digits: &str| {
        if digits.ends_with(|c: char| c.is_ascii_digit()) { digits.to_owned() } else { format!("{digits}0") }
    };
    Some(format!("write {}.{}", filled(whole), filled(part)))
}

#[cfg(test)]
mod tests {
    use crate::file::tests::{SMALL, fault_of};
    /// What beginners write, and the cure that the line must name.
    #[test]
    fn usual_mistakes_are_told_with_their_cure() {
        let cases = [
            (
                "[[sphere]]",
                "[sphere]",
                "test.toml:10:1: a scene has a list of these: write [[sphere]], in double brackets",
            ),
            (
                "[[sphere]]",
                "[sphere]\nradius = 2\n[sphere]",
                "duplicate key; a scene has a list of these: write each as [[sphere]]",
            ),
            ("[camera]", "[sky]\n[sky]\n[camera]", "duplicate key; there is one [sky]: put all of it under one header"),
            ("[camera]", "[[camera]]", "; there is one such table: write [camera], in single brackets"),
            ("[material.white]", "[[material.white]]", "write [material.white], in single brackets"),
            ("radius = 1", "radius = 0,6", "test.toml:12:11: unexpected key or value"),
            ("radius = 1", "radius = 0,6", "; numbers have a decimal point: write 0.6, not 0,6"),
            ("[0.5, 0.5, 0.5]", "[0,5, 0,5, 0,5]", "numbers have a decimal point: write 0.5, not 0,5"),
            (
                "center = [0, 0, 0]",
                "center = [-1,25, 3, 4]",
                "found one of 4; numbers have a decimal point: write -1.25, not -1,25",
            ),
            ("radius = 1", "radius = \"1,5\"", "; a number has no quotes: write 1.5"),
            ("radius = 1", "radius = .5", "; write 0.5"),
            ("radius = 1", "radius = -.5", "; write -0.5"),
            ("radius = 1", "radius = 5.", "; write 5.0"),
            ("radius = 1", "radius = 1;", "; a value ends with its line: write 1"),
            ("radius = 1", "radius = 1/2", "; a file does not calculate: write 0.5"),
            ("radius = 1", "radius = 1 // large", "; a remark begins with #"),
            ("fov_y = 45", "fov_y = 45°", "; a number stands alone: write 45"),
            ("center = [0, 0, 0]", "center = [0 1 2]", "; a list has commas: write 0, 1, 2"),
            ("center = [0, 0, 0]", "center = (0, 1, 2)", "; a list stands in square brackets: [0, 1, 2]"),
            ("material = \"white\"", "material = white", "; write \"white\""),
            ("material = \"white\"", "material = \"whte\"", "the file has white; did you mean 'white'?"),
            ("material = \"white\"", "", "missing field `material`; say which it wears, like material = \"white\""),
            (
                "[material.white]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }",
                "",
                "the file has none; add [material.white] with ",
            ),
            ("[material.white]", "[white]", "; a material of this name is [material.white]"),
            ("radius = 1", "radios = 1", "expected one of `center`, `radius`, `material`; did you mean `radius`?"),
            ("center =", "Centre =", "; did you mean `center`?"),
            ("[camera]", "[camra]", "; did you mean `camera`?"),
            ("[[sphere]]", "[[cube]]", "; did you mean `box`?"),
            ("fov_y = 45", "fov = 45", "; did you mean `fov_y`?"),
            ("diffuse = { albedo = [0.5, 0.5, 0.5] }", "color = [1, 1, 1]", "; did you mean `diffuse`?"),
            ("[0.5, 0.5, 0.5]", "[255, 128, 0]", "what a screen calls 255, 128, 0 is [1.0, 0.216, 0.0]"),
            ("[0.5, 0.5, 0.5]", "\"#ff8000\"", "what a screen calls 255, 128, 0 is [1.0, 0.216, 0.0]"),
            (SMALL, "", "missing field `camera`; a scene begins with [camera] and its eye, target and fov_y"),
        ];
        for (from, to, expected) in cases {
            assert!(SMALL.contains(from), "{from}");
            let said = fault_of(&SMALL.replace(from, to));
            assert!(said.contains(expected) && said.lines().count() == 1, "'{to}' said: {said}");
        }
    }

    /// Advice is for mistakes that are certain: other faults keep the parser's words alone.
    #[test]
    fn other_faults_are_told_as_they_are() {
        for (from, to, expected) in [
            ("radius = 1", "radius = 0", "0 is not a finite number from 1e-12 to 1e12"),
            ("[0.5, 0.5, 0.5]", "[0.5, 1.5, 0.5]", "1.5 is not a number from 0 to 1"),
            ("center = [0, 0, 0]", "center = [1,2,3,4]", "found one of 4"),
            ("radius = 1", "radius = \"big\"", "expected a finite number from 1e-12 to 1e12"),
            ("radius = 1", "xylophone = 1", "expected one of `center`, `radius`, `material`"),
        ] {
            let said = fault_of(&SMALL.replace(from, to));
            assert!(said.ends_with(expected), "'{to}' said: {said}");
        }
    }
}
