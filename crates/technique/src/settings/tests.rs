//! What a row of the table says is what it takes.

use super::*;

/// Every setting is read back as it is told, shown in every kind, and refused with what was expected.
#[test]
fn what_a_setting_says_is_what_it_takes() {
    for technique in TechniqueName::ALL {
        let mut pane = PaneSettings::of(technique);
        for setting in all_of_panes().filter(|setting| setting.is_of(technique)) {
            for word in examples(&setting.kind_in(technique)) {
                let value =
                    setting.kind_in(technique).parse(&word).unwrap_or_else(|e| panic!("{} {word}: {e}", setting.name));
                (setting.set)(&mut pane, value);
                assert_eq!((setting.get)(&pane), Some(value), "{} {word}", setting.name);
                assert_eq!(setting.kind_in(technique).parse(&value.to_string()), Ok(value), "{}", setting.name);
            }
            assert!(setting.kind.parse("nonsense").is_err(), "{}", setting.name);
        }
    }
    let mut changes = SceneChanges::default();
    for setting in OF_SCENES {
        for word in examples(&setting.kind) {
            let value = setting.kind.parse(&word).unwrap();
            (setting.set)(&mut changes, value);
            assert_eq!((setting.get)(&changes), Some(value), "{}", setting.name);
        }
    }
}

#[test]
fn the_defaults_are_those_of_a_new_pane() {
    for technique in TechniqueName::ALL {
        let pane = PaneSettings::of(technique);
        for setting in all_of_panes().filter(|setting| setting.is_of(technique)) {
            // how many samples there are depends on who asks
            if setting.name != "spp" {
                assert_eq!((setting.get)(&pane), setting.default, "{}", setting.name);
            }
        }
    }
}

#[test]
fn what_is_reset_is_a_new_panes_or_the_scenes_and_all_else_stays() {
    for technique in TechniqueName::ALL {
        for setting in all_of_panes().filter(|setting| setting.is_of(technique)) {
            let mut pane = PaneSettings::of(technique);
            for other in all_of_panes().filter(|other| other.is_of(technique)) {
                let word = examples(&other.kind_in(technique)).pop().unwrap();
                (other.set)(&mut pane, other.kind_in(technique).parse(&word).unwrap());
            }
            let before = pane;
            pane.reset(setting);
            assert_eq!((setting.get)(&pane), (setting.get)(&PaneSettings::of(technique)), "{}", setting.name);
            let others = all_of_panes().filter(|other| other.is_of(technique) && other.name != setting.name);
            for other in others {
                assert_eq!((other.get)(&pane), (other.get)(&before), "{} by {}", other.name, setting.name);
            }
        }
    }
    let mut changes = SceneChanges { refraction_ratio: Some(0.5), sun_radius: Some(1.0), ..SceneChanges::default() };
    changes.reset(of_scenes("sun-radius").unwrap());
    assert_eq!(changes, SceneChanges { refraction_ratio: Some(0.5), ..SceneChanges::default() });
    let of_one = SceneChanges { edits: "{ material.ice.ior = 2 }".parse().unwrap(), ..changes };
    let mut changes = SceneChanges { sun_radius: Some(1.0), ..of_one.clone() };
    changes.reset(of_scenes("sun-radius").unwrap());
    assert_eq!(changes, of_one);
}

#[test]
fn names_are_unique() {
    let mut names: Vec<_> = all_of_panes().map(|s| s.name).chain(OF_SCENES.iter().map(|s| s.name)).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

fn examples(kind: &Kind) -> Vec<String> {
    match kind {
        Kind::Number(range) => [range.start(), range.end()].map(f32::to_string).into(),
        Kind::DegreesBelow(most) => ["0".into(), most.next_down().to_string()].into(),
        Kind::Whole(range) => [range.start(), range.end()].map(u32::to_string).into(),
        Kind::Choice(words) => words.iter().map(|word| (*word).to_owned()).collect(),
        Kind::Bounces => ["0", "7", "inf"].map(str::to_owned).into(),
        Kind::Roulette => ["off", "throughput", "0.5", "0.8+throughput"].map(str::to_owned).into(),
        Kind::LightPaths => ["all", "direct", "bounce-3", "L(D|S)*[GS]+.?E"].map(str::to_owned).into(),
        Kind::Repairs => ["none", "all", "sky+fresnel"].map(str::to_owned).into(),
        Kind::Bugs => ["none", "no-cosine", "width-twice+clamped"].map(str::to_owned).into(),
    }
}

#[test]
fn light_paths_are_refused_with_the_column_and_told_as_they_are_read() {
    let row = of_panes("light").unwrap();
    let refused = row.kind.parse("LDxE").unwrap_err();
    assert!(refused.starts_with("all, direct") && refused.contains(": column 3: expected L, D"), "{refused}");
    let brief = |word: &str| row.brief(row.kind.parse(word).unwrap());
    let told = ["all", "direct", "bounce-2", "up-to-0", "from-9", "L S+ D E"].map(brief);
    let words = ["all light", "only direct light", "only bounce 2", "only up to bounce 0", "only from bounce 9 on"];
    assert_eq!(told[..5], words);
    assert_eq!(told[5], "only LS+DE");
}
