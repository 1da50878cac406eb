use super::expression::Expression;
use super::*;

/// All paths of at most so many vertices, by their letters from the light.
fn paths(most: usize) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut last = all.clone();
    for _ in 0..most {
        last = last.iter().flat_map(|path| ["D", "G", "S"].map(|letter| format!("{path}{letter}"))).collect();
        all.extend(last.iter().cloned());
    }
    all.iter().map(|path| format!("L{path}E")).collect()
}

/// Whether an expression matches all of `path`, by trying every way: what the automaton is held against. Knows no spaces.
fn matches(expression: &str, path: &str) -> bool {
    ends(expression.as_bytes(), path.as_bytes()).contains(&path.len())
}

/// Where the first letters of a path may end that match a whole expression.
fn ends(expression: &[u8], path: &[u8]) -> Vec<usize> {
    let mut depth = 0;
    for (at, letter) in expression.iter().enumerate() {
        depth += i32::from(*letter == b'(') - i32::from(*letter == b')');
        if depth == 0 && *letter == b'|' {
            let [left, right] = [&expression[..at], &expression[at + 1..]].map(|side| ends(side, path));
            return [left, right].concat();
        }
    }
    let Some(first) = expression.first() else { return vec![0] };
    let atom = match first {
        b'(' => group(expression),
        b'[' => 1 + expression.iter().position(|letter| *letter == b']').unwrap(),
        _ => 1,
    };
    let once = |path: &[u8]| match first {
        b'(' => ends(&expression[1..atom - 1], path),
        b'[' => one_of(&expression[1..atom - 1], path),
        b'.' => one_of(b"DGS", path),
        letter => one_of(&[*letter], path),
    };
    let sign = expression.get(atom).copied().filter(|sign| b"*+?".contains(sign));
    let rest = &expression[atom + usize::from(sign.is_some())..];
    let mut reached: Vec<usize> = if matches!(sign, Some(b'*' | b'?')) { vec![0] } else { once(path) };
    if sign == Some(b'?') {
        reached.extend(once(path));
    }
    if matches!(sign, Some(b'*' | b'+')) {
        let mut at = 0;
        while at < reached.len() {
            let from = reached[at];
            let further: Vec<_> = once(&path[from..]).into_iter().map(|end| from + end).collect();
            reached.extend(further.into_iter().filter(|end| !reached.contains(end)).collect::<Vec<_>>());
            at += 1;
        }
    }
    reached.into_iter().flat_map(|from| ends(rest, &path[from..]).into_iter().map(move |end| from + end)).collect()
}

fn group(expression: &[u8]) -> usize {
    let mut depth = 0;
    1 + expression
        .iter()
        .position(|letter| {
            depth += i32::from(*letter == b'(') - i32::from(*letter == b')');
            depth == 0
        })
        .unwrap()
}

fn one_of(letters: &[u8], path: &[u8]) -> Vec<usize> {
    path.first().filter(|letter| letters.contains(letter)).map(|_| 1).into_iter().collect()
}

/// Whether the automaton counts a path, which it reads from the eye.
fn counted(expression: &str, path: &str) -> bool {
    let Automaton { rows } = Automaton::new(&Expression::parse(expression).unwrap()).unwrap();
    let surfaces = path[1..path.len() - 1].chars().rev();
    let row = surfaces.fold(rows[BEGINS as usize], |row, surface| {
        let place = "DGS".find(surface).unwrap();
        rows[(row >> (8 * place) & 0xff) as usize]
    });
    row & ACCEPTS != 0
}

#[test]
fn the_automaton_counts_what_the_expression_matches() {
    let expressions = [
        "LE",
        "LDE",
        "LD+E",
        "LS+DE",
        "LDS*E",
        "L(D|S)*E",
        "L[DG]?S*E",
        "L.+[DG]S*E",
        "L.*E",
        "LE|LDE|LSSE",
        "L(DS|SD)+E",
        "L(D?S)*GE",
        "L((D|G)S)*.?E",
        "(L(D|S)+|LG)E",
        "L(D*)*S?(E)",
        "LD.?.?SE",
    ];
    for expression in expressions {
        for path in paths(6) {
            assert_eq!(counted(expression, &path), matches(expression, &path), "{expression} and {path}");
        }
    }
}

#[test]
fn named_classes_part_all_paths_as_they_say() {
    let counted_by = |named: Named, path: &str| counted(&named.expression(), path);
    for path in paths(6) {
        let vertices = path.len() as u32 - 2;
        let seen = path.trim_end_matches('E').trim_end_matches('S');
        let is_direct = seen.len() <= 2 && !seen.ends_with('S');
        assert_eq!(counted_by(Named::Direct, &path), is_direct, "{path}");
        assert_eq!(counted_by(Named::Indirect, &path), !is_direct, "{path}");
        assert_eq!(counted_by(Named::Emitted, &path), vertices == 0, "{path}");
        for bounces in 0..=6 {
            assert_eq!(counted_by(Named::Bounce(bounces), &path), vertices == bounces + 1, "{bounces} {path}");
            assert_eq!(counted_by(Named::UpTo(bounces), &path), vertices <= bounces + 1, "{bounces} {path}");
            assert_eq!(counted_by(Named::From(bounces), &path), vertices > bounces, "{bounces} {path}");
        }
        assert!(counted_by(Named::All, &path));
    }
    for named in [Named::Bounce(20), Named::UpTo(20), Named::From(20)] {
        assert!(LightPaths::from(named).automaton().is_some(), "{named}");
    }
}

#[test]
fn what_is_read_is_what_is_said() {
    for text in ["all", "emitted", "direct", "indirect", "bounce-0", "up-to-20", "from-9", "LS+DE", "L(D|S)*E"] {
        assert_eq!(LightPaths::parse(text).unwrap().to_string(), text);
    }
    assert_eq!(LightPaths::parse(" L S+ D E ").unwrap().to_string(), "LS+DE");
    assert_eq!(LightPaths::parse("bounce-07").unwrap().to_string(), "bounce-7");
    assert!(LightPaths::parse("all").unwrap().is_all() && LightPaths::default().automaton().is_none());
}

#[test]
fn what_is_no_path_is_refused_in_its_column() {
    let refused = |text: &str| LightPaths::parse(text).unwrap_err().to_string();
    let begins = [
        ("LDxE", "column 3: expected L, D, G"),
        ("L S+ d E", "column 6: expected L, D, G"),
        ("", "column 1: expected L, D, G"),
        ("L+*|", "column 5: expected L, D, G"),
        ("L*D(SE", "column 4: this ( has no )"),
        ("LD)E", "column 3: this ) has no ("),
        ("L[DX]E", "column 4: expected one or more of D, G and S"),
        ("L[]E", "column 3: expected one or more of D, G and S"),
        ("bounce-21", "K in bounce-K, up-to-K and from-K is a number from 0 to 20"),
        ("up-to-", "K in bounce-K"),
        (" from-1.5", "K in bounce-K"),
        ("bounced", "column 1: expected L, D, G"),
        ("Lä", "column 2: expected L, D, G"),
        ("LD", "no path is like that"),
        ("EDL", "no path is like that"),
        ("LDEDE", "no path is like that"),
    ];
    for (text, begin) in begins {
        assert!(refused(text).starts_with(begin), "{text}: {}", refused(text));
    }
    assert_eq!(refused(&format!("L{}E", "D".repeat(31))), "an expression has at most 32 letters and signs");
    // whether the sixth surface from the light is D: from the eye that takes a state for each set of the last six
    assert_eq!(refused("L.....D.*E"), "this takes more than 31 states to read: say less at once");
}

/// Each group is read inside the one around it: so many would take more than a thread's stack.
#[test]
fn an_expression_of_any_length_is_refused_without_being_read() {
    let groups = 100_000;
    let nested = format!("L{}D{}E", "(".repeat(groups), ")".repeat(groups));
    for text in ["L".to_owned() + &"(".repeat(groups), nested, "(".repeat(33), "ä".repeat(groups)] {
        assert_eq!(LightPaths::parse(&text), Err(LightPathsError::TooLong), "{} bytes", text.len());
    }
    let spaced = format!("L{}D E", " ".repeat(groups));
    assert_eq!(LightPaths::parse(&spaced).unwrap().to_string(), "LDE", "spaces are of no account");
}
