//! Where the parser stopped: the words around it, and what is wrong with whole tables.

use std::ops::Range;

/// A place of a text.
pub(super) struct Place<'a> {
    pub text: &'a str,
    pub at: Range<usize>,
}

impl<'a> Place<'a> {
    pub fn before(&self) -> &'a str {
        self.text.get(..self.at.start).unwrap_or_default()
    }

    pub fn after(&self) -> &'a str {
        self.text.get(self.at.start..).unwrap_or_default()
    }

    pub fn rest_of_line(&self) -> &'a str {
        self.after().lines().next().unwrap_or_default().trim()
    }

    fn line_start(&self) -> usize {
        self.before().rfind('\n').map_or(0, |end| end + 1)
    }

    pub fn line(&self) -> &'a str {
        self.text.get(self.line_start()..).unwrap_or_default().lines().next().unwrap_or_default()
    }

    /// The last name before the place on its line that has a value, and the text from that value to the line's end.
    pub fn assignment(&self) -> Option<(&'a str, &'a str)> {
        let sign = self.before().get(self.line_start()..)?.rfind('=')?;
        let (names, value) = (&self.line()[..sign], &self.line()[sign + 1..]);
        let key = names.trim_end().rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
        Some((key, value.trim()))
    }

    /// The list of values without lists in it that begins here, or that this place is in.
    pub fn list(&self) -> Option<&'a str> {
        let start = match self.after().starts_with('[') {
            true => self.at.start,
            false => self.before().rfind('[')?,
        };
        let list = self.text.get(start + 1..)?;
        list.get(..list.find(']')?).filter(|list| start + 1 + list.len() >= self.at.start)
    }

    /// The last header before this place, without its brackets.
    pub fn header(&self) -> Option<&'a str> {
        let headers = self.before().lines().rev().filter_map(|line| line.trim().strip_prefix('['));
        headers
            .filter(|header| !header.contains('='))
            .find_map(|header| header.split([']', '[']).find(|p| !p.is_empty()))
    }

    /// One table where there is a list of them. The parser's words, of maps and sequences, tell a beginner nothing.
    pub fn single_brackets(&self, message: &str) -> Option<String> {
        let header =
            self.line().trim().strip_prefix('[').filter(|_| message == "invalid type: map, expected a sequence")?;
        let name = header.split(']').next().filter(|name| !name.is_empty())?;
        Some(format!("a scene has a list of these: write [[{name}]], in double brackets"))
    }

    /// A list of tables where there is one.
    pub fn double_brackets(&self, message: &str) -> Option<String> {
        let doubled = message.strip_prefix("invalid type: sequence, expected a ")?;
        let (name, rest) = self.after().strip_prefix("[[")?.split_once("]]")?;
        if doubled == "map" && name == "material" {
            let named = |line: &'a str| line.trim().strip_prefix("name")?.trim().strip_prefix('=').map(str::trim);
            let name = rest.lines().skip(1).take_while(|line| !line.trim().starts_with('[')).find_map(named);
            let name = name.map_or("NAME", |name| name.trim_matches('"'));
            return Some(format!("a material has its name in its header: write [material.{name}]"));
        }
        (doubled == "table of names and values")
            .then(|| format!("there is one such table: write [{name}], in single brackets"))
    }

    pub fn stated_twice(&self, message: &str) -> Option<String> {
        let header = self.line().trim().strip_prefix('[').filter(|_| message == "duplicate key")?;
        let name = header.split(']').next()?;
        Some(match name {
            "sphere" | "rectangle" | "disk" | "box" | "mesh" | "statue" | "instance" | "point_light" => {
                format!("a scene has a list of these: write each as [[{name}]], in double brackets")
            }
            name => format!("there is one [{name}]: put all of it under one header"),
        })
    }

    pub fn missing_field(&self, message: &str) -> Option<String> {
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

/// The value that a text begins with, on one line.
pub(super) fn value(text: &str) -> String {
    let text = text.trim_start();
    let (mut depth, mut quoted) = (0, false);
    let end = text.find(|c| {
        quoted ^= c == '"';
        if !quoted {
            depth += i32::from(matches!(c, '[' | '{' | '(')) - i32::from(matches!(c, ']' | '}' | ')'));
        }
        !quoted && (depth < 0 || c == '#' || depth == 0 && matches!(c, ',' | '\n'))
    });
    text[..end.unwrap_or(text.len())].split_whitespace().collect::<Vec<_>>().join(" ")
}
