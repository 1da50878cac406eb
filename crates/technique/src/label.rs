//! What pictures are called beside each other: by their techniques, or by the settings in which they differ.

use crate::settings::{Setting, Value, all_of_panes, grouped, light_words};
use crate::{FakeSettings, PaneSettings, Technique, TracedSettings};
use film::Feature;
use pathtrace::{Integrator, PathSettings};
use raster::{Fake, Show};
use scene::Scene;

impl Technique {
    /// Its name with the setting that says most: "Fake, fair", "Path tracing, light", "Whitted, depth 8".
    pub fn label(&self) -> String {
        if self.feature().is_some() || self.denoise().shows_the_weight() {
            return self.title();
        }
        let says_most = match self {
            Technique::Fake(fake) => match (fake.fake, fake.repairs.count()) {
                (Fake::Fair, 0) | (Fake::AsTaught, _) => fake.fake.name().to_owned(),
                (Fake::Fair, 1) => format!("{}, 1 repair", fake.fake.name()),
                (Fake::Fair, count) => format!("{}, {count} repairs", fake.fake.name()),
            },
            Technique::Traced(traced) => match traced.integrator {
                Integrator::Path(path) => path.estimator.name().to_owned(),
                Integrator::Whitted(tree) => format!("depth {}", tree.depth),
                Integrator::Photon(photon) if photon.points => "points".into(),
                Integrator::Photon(photon) => format!("{} photons a pass", grouped(photon.photons)),
                Integrator::LightTracing(light) => format!("{} photons a pass", grouped(light.photons)),
                Integrator::Metropolis(metropolis) => format!("{} chains", metropolis.chains),
                Integrator::Normals(normals) => format!("{} axes", normals.space.name()),
            },
        };
        let light = self.light_words().map_or_else(String::new, |light| format!("{light}, "));
        format!("{}, {light}{says_most}", self.title())
    }

    /// What tells it from another picture of `scene`: of one technique all settings that differ, as "Path tracing,
    /// 0 bounces" beside "Path tracing, 1 bounce"; else [`Technique::label`].
    pub fn label_beside(&self, other: &Technique, scene: &Scene) -> String {
        let mut differing = self.settings_unlike(other, scene);
        if self.title() != other.title() || differing.is_empty() {
            return self.label();
        }
        if self.light() == other.light() {
            differing.splice(..0, self.light_words());
        }
        format!("{}, {}", self.title(), differing.join(", "))
    }

    /// "only direct light", where not all light counts.
    fn light_words(&self) -> Option<String> {
        let light = self.light();
        (!light.is_all()).then(|| light_words(light))
    }

    /// Its name; or what it shows in place of the scene's light.
    fn title(&self) -> String {
        match self {
            Technique::Fake(FakeSettings { show: Show::Feature(feature), .. }) => {
                format!("{} of the fake", titled(*feature))
            }
            Technique::Traced(TracedSettings { feature: Some(feature), .. }) => format!("{} by rays", titled(*feature)),
            Technique::Traced(traced) if self.denoise().shows_the_weight() => {
                format!("Trust in the samples beside {}", traced.denoise.denoiser.name())
            }
            Technique::Fake(FakeSettings { show: Show::CubeFaces, .. }) => "Cube faces of the fake".into(),
            Technique::Fake(FakeSettings { show: Show::ShadowMap, .. }) => "Shadow map of the fake".into(),
            Technique::Traced(TracedSettings { integrator: Integrator::Path(path), .. }) if path.is_broken() => {
                format!("{}, {}", self.name().in_full(), bug_words(path))
            }
            Technique::Fake(_) | Technique::Traced(_) => self.name().in_full().into(),
        }
    }

    /// Its values of the settings that change its picture of `scene` and have another value in `other`.
    fn settings_unlike(&self, other: &Technique, scene: &Scene) -> Vec<String> {
        let panes @ [own, _] = [self, other].map(|technique| PaneSettings::from(*technique));
        let used = all_of_panes().filter(|row| own.is_changed_by(row, scene));
        let unlike = used.filter_map(|row| {
            let [own, others] = panes.map(|pane| (row.get)(&pane).or_else(|| (row.own)(scene)));
            own.filter(|_| own != others).map(|own| told_apart(row, own, others))
        });
        unlike.collect()
    }
}

/// "2 bugs on", and whether one is hidden.
fn bug_words(path: &PathSettings) -> String {
    match (path.bugs.count(), path.find_bug) {
        (0, _) => "a bug is on".into(),
        (1, 0) => "1 bug on".into(),
        (count, 0) => format!("{count} bugs on"),
        (1, _) => "1 bug on and one to find".into(),
        (count, _) => format!("{count} bugs on and one to find"),
    }
}

fn titled(feature: Feature) -> &'static str {
    match feature {
        Feature::Albedo => "Albedo",
        Feature::Normal => "Normals",
        Feature::Depth => "Depths",
    }
}

/// What a label calls a value, in as many digits as tell it from the other one.
fn told_apart(row: &Setting<PaneSettings>, own: Value, others: Option<Value>) -> String {
    let rounded = row.control.look.rounded(own);
    let alike = others.map(|others| row.control.look.rounded(others)) == Some(rounded);
    row.brief(if alike { own } else { rounded })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TechniqueName;
    use crate::settings::of_panes;

    fn with(technique: TechniqueName, changes: &[(&str, &str)]) -> Technique {
        let mut pane = PaneSettings::of(technique);
        for (name, word) in changes {
            let row = of_panes(name).unwrap();
            let value: Value = row.kind.parse(word).unwrap();
            (row.set)(&mut pane, value);
        }
        pane.in_use()
    }

    fn labels(scene: &str, technique: TechniqueName, changes: [&[(&str, &str)]; 2]) -> [String; 2] {
        let scene = scene::builtin::named(scene).unwrap();
        let [a, b] = changes.map(|changes| with(technique, changes));
        [a.label_beside(&b, &scene), b.label_beside(&a, &scene)]
    }

    #[test]
    fn two_techniques_are_told_apart_by_their_names() {
        let scene = scene::builtin::named("whitted").unwrap();
        let [fake, path, whitted, normals] =
            [TechniqueName::Raster, TechniqueName::Path, TechniqueName::Whitted, TechniqueName::Normals]
                .map(|name| with(name, &[("bounces", "0"), ("spp", "4")]));
        assert_eq!(fake.label_beside(&path, &scene), "Fake, fair");
        let repaired = |repairs: &str| with(TechniqueName::Raster, &[("repairs", repairs)]).label();
        let all = format!("Fake, fair, {} repairs", raster::Repair::ALL.len());
        assert_eq!(["sky", "all"].map(repaired), ["Fake, fair, 1 repair".to_owned(), all]);
        assert_eq!(path.label_beside(&fake, &scene), "Path tracing, light");
        assert_eq!(whitted.label_beside(&path, &scene), "Whitted, depth 8");
        assert_eq!(normals.label_beside(&path, &scene), "Normals, world axes");
    }

    #[test]
    fn bugs_stand_in_every_label() {
        let path = |changes: &[(&str, &str)]| with(TechniqueName::Path, changes);
        let labels = [("bugs", "no-cosine"), ("bugs", "no-cosine+clamped"), ("find-bug", "7"), ("show", "albedo")]
            .map(|change| path(&[change]).label());
        let expected = ["1 bug on, light", "2 bugs on, light", "a bug is on, light"];
        assert_eq!(labels[..3], expected.map(|words| format!("Path tracing, {words}")));
        assert_eq!(path(&[("bugs", "clamped"), ("find-bug", "7"), ("show", "albedo")]).label(), labels[3]);
        let both = path(&[("bugs", "clamped"), ("find-bug", "7")]).label();
        assert_eq!(both, "Path tracing, 1 bug on and one to find, light");
        let beside = self::labels("cornell", TechniqueName::Path, [&[("bugs", "clamped")], &[]]);
        assert_eq!(beside, ["Path tracing, 1 bug on, light", "Path tracing, light"]);
        let other = self::labels("cornell", TechniqueName::Path, [&[("bugs", "clamped")], &[("bugs", "no-pi")]]);
        assert_eq!(other, ["Path tracing, 1 bug on, bugs: clamped", "Path tracing, 1 bug on, bugs: no-pi"]);
    }

    #[test]
    fn photons_are_told_by_their_number_and_by_what_they_show() {
        let points = ("photon-picture", "points");
        let shown = labels("whitted", TechniqueName::Photon, [&[points], &[]]);
        assert_eq!(shown, ["Photon mapping, points", "Photon mapping, light"]);
        assert_eq!(with(TechniqueName::Photon, &[points]).label(), "Photon mapping, points");
        let radii = labels("whitted", TechniqueName::Photon, [&[("radius", "0.1")], &[("alpha", "0.5")]]);
        assert_eq!(radii, ["Photon mapping, radius 0.1, alpha 0.667", "Photon mapping, radius 0.266, alpha 0.5"]);
        let hidden = labels("whitted", TechniqueName::Photon, [&[points, ("radius", "0.1")], &[points]]);
        assert_eq!(hidden, ["Photon mapping, points"; 2], "points are gathered within no radius");
        let light = with(TechniqueName::LightTracing, &[("photons", "1024")]);
        assert_eq!(light.label(), "Light tracing, 1024 photons a pass");
        let many = labels("whitted", TechniqueName::Photon, [&[], &[("photons", "1048576")]]);
        assert_eq!(many, ["Photon mapping, 131,072 photons a pass", "Photon mapping, 1,048,576 photons a pass"]);
        assert_eq!(with(TechniqueName::LightTracing, &[]).label(), "Light tracing, 131,072 photons a pass");
    }

    #[test]
    fn one_technique_is_told_apart_by_all_settings_that_differ_and_by_no_other() {
        use TechniqueName::{Path, Raster, Whitted};
        let bounces = labels("whitted", Path, [&[("bounces", "0")], &[("bounces", "1")]]);
        assert_eq!(bounces, ["Path tracing, 0 bounces", "Path tracing, 1 bounce"]);
        let several = labels(
            "cornell",
            Path,
            [
                &[("spp", "16"), ("roulette", "0.8"), ("estimator", "uniform"), ("branches", "4")],
                &[("seed", "2"), ("sampler", "independent")],
            ],
        );
        assert_eq!(
            several,
            [
                "Path tracing, 16 spp, sobol random numbers, roulette P 0.8, uniform, N = 4, seed 1",
                "Path tracing, 256 spp, independent random numbers, roulette by throughput, light, N = 1, seed 2",
            ]
        );
        let fakes = labels("whitted", Raster, [&[("shading", "phong"), ("segments", "8")], &[("reflectivity", "0.5")]]);
        assert_eq!(
            fakes,
            [
                "Fake, phong highlight, reflectivity 0.9, segments 8",
                "Fake, three highlight, reflectivity 0.5, segments 100"
            ]
        );
        assert_eq!(labels("cornell", Whitted, [&[("depth", "1")], &[]]), ["Whitted, depth 1", "Whitted, depth 8"]);
    }

    #[test]
    fn what_changes_nothing_in_a_scene_tells_nothing_apart() {
        let glassless = labels("cornell", TechniqueName::Raster, [&[("reflectivity", "0.1")], &[]]);
        assert_eq!(glassless, ["Fake, fair", "Fake, fair"]);
        // the scene's own value, stated
        let stated = labels("whitted", TechniqueName::Raster, [&[("reflectivity", "0.9")], &[]]);
        assert_eq!(stated, ["Fake, fair", "Fake, fair"]);
    }

    #[test]
    fn a_setting_that_changes_nothing_beside_the_others_tells_nothing_apart() {
        use TechniqueName::{Path, Raster, Whitted};
        let direct = |roulette| [("bounces", "0"), ("roulette", roulette)];
        let labels_of = |scene, a, b| labels(scene, Path, [&direct(a), &direct(b)]);
        assert_eq!(labels_of("cornell", "off", "throughput"), ["Path tracing, light"; 2], "no path goes on");
        assert_eq!(labels_of("cornell", "off", "0.5"), ["Path tracing, light"; 2]);
        let sky = labels_of("whitted", "off", "0.5");
        assert_eq!(sky, ["Path tracing, no roulette", "Path tracing, roulette P 0.5"], "the sky may still be met");
        let lengths = labels("cornell", Path, [&direct("off"), &[]]);
        let unlimited = "Path tracing, no limit of bounces, roulette by throughput";
        assert_eq!(lengths, ["Path tracing, 0 bounces", unlimited]);
        let sky_light = labels("cornell", Raster, [&[("ambient", "0.1")], &[("ambient", "0.5")]]);
        assert_eq!(sky_light, ["Fake, fair"; 2], "fair scales the light of a sky that is black there");
        let point = |rays| [("traced-sun", "0"), ("shadow-rays", rays)];
        assert_eq!(labels("whitted", Whitted, [&point("1"), &point("4")]), ["Whitted, depth 8"; 2]);
    }

    #[test]
    fn a_part_of_the_light_is_called_so_beside_any_picture() {
        use TechniqueName::{Path, Whitted};
        let direct = ("light", "direct");
        assert_eq!(with(Whitted, &[direct]).label(), "Whitted, only direct light, depth 8");
        let parts = labels("cornell", Path, [&[direct], &[("light", "LDDE")]]);
        assert_eq!(parts, ["Path tracing, only direct light", "Path tracing, only LDDE"]);
        let same = labels("cornell", Path, [&[direct, ("seed", "2")], &[direct]]);
        assert_eq!(same, ["Path tracing, only direct light, seed 2", "Path tracing, only direct light, seed 1"]);
        let part = with(Path, &[direct]);
        assert!(part.shows_the_scene() && !part.has_a_reference() && with(Path, &[]).has_a_reference());
        assert!(with(TechniqueName::Photon, &[direct]).has_a_reference(), "photons show all light");
    }

    #[test]
    fn means_of_runs_and_a_view_of_trust_are_called_so() {
        let denoised = ("denoise", "unet");
        let runs = labels("cornell", TechniqueName::Path, [&[denoised, ("runs", "8")], &[denoised]]);
        assert_eq!(runs, ["Path tracing, mean of 8 runs", "Path tracing, one run"]);
        let view = [denoised, ("trust", "0.5"), ("show", "trust")];
        let shown = with(TechniqueName::Path, &view);
        assert_eq!((shown.label().as_str(), shown.shows_the_scene()), ("Trust in the samples beside unet", false));
        let nothing = with(TechniqueName::Path, &[denoised, ("show", "trust")]);
        assert_eq!((nothing.label().as_str(), nothing.shows_the_scene()), ("Path tracing, light", true));
        let albedo =
            labels("cornell", TechniqueName::Path, [&[("show", "albedo"), ("runs", "8")], &[("show", "albedo")]]);
        assert_eq!(albedo, ["Albedo by rays"; 2], "of which there is no mean");
    }

    #[test]
    fn how_caustics_are_found_is_told_on_both_sides() {
        let of = |a, b| labels("whitted", TechniqueName::Path, [&[a], &[b]]);
        let cones = |a, b| of(("cones", a), ("cones", b));
        assert_eq!(cones("off", "auto"), ["Path tracing, no cones", "Path tracing, cones at glass"]);
        let all = ["Path tracing, cones at all glass and mirrors", "Path tracing, cones at glass"];
        assert_eq!(cones("all", "auto"), all);
        let split = of(("split-glass", "off"), ("split-glass", "on"));
        assert_eq!(split, ["Path tracing, glass not split", "Path tracing, glass split"]);
        let connections = of(("connections", "off"), ("connections", "on"));
        assert_eq!(connections, ["Path tracing, no connections", "Path tracing, connections"]);
        let dull = labels("cornell", TechniqueName::Path, [&[("cones", "off")], &[]]);
        assert_eq!(dull, ["Path tracing, light"; 2], "no glass, no mirror");
        let naive = |cones| [("estimator", "uniform"), ("cones", cones)];
        let naive = labels("whitted", TechniqueName::Path, [&naive("off"), &naive("auto")]);
        assert_eq!(naive, ["Path tracing, uniform"; 2], "chance takes no part for cones");
    }

    #[test]
    fn numbers_are_rounded_unless_they_are_alike_then() {
        let phong = labels("phong", TechniqueName::Raster, [&[("specular", "0.06666667")], &[("specular", "0.5")]]);
        assert_eq!(phong, ["Fake, specular 0.067", "Fake, specular 0.5"]);
        let close = labels("phong", TechniqueName::Raster, [&[("specular", "0.0666")], &[("specular", "0.0667")]]);
        assert_eq!(close, ["Fake, specular 0.0666", "Fake, specular 0.0667"]);
    }

    #[test]
    fn a_map_of_the_fake_is_called_by_its_name_and_by_what_changes_it() {
        let maps = |show, changes: [&[(&str, &str)]; 2]| {
            let [a, b] = changes.map(|changes| [&[("show", show)], changes].concat());
            labels("whitted", TechniqueName::Raster, [&a, &b])
        };
        let fakes = maps("shadow-map", [&[("fake", "as-taught")], &[]]);
        assert_eq!(fakes, ["Shadow map of the fake, as-taught", "Shadow map of the fake, fair"]);
        let highlights: [&[(&str, &str)]; 2] = [&[("shininess", "5"), ("shading", "phong"), ("cube-map", "512")], &[]];
        assert_eq!(maps("shadow-map", highlights), ["Shadow map of the fake, fair"; 2]);
        let faces = maps("cube-faces", [&[("cube-map", "64")], &[("cube-map", "512")]]);
        assert_eq!(faces, ["Cube faces of the fake, cube map 64", "Cube faces of the fake, cube map 512"]);
        let traced = with(TechniqueName::Path, &[("show", "albedo")]);
        let fake = with(TechniqueName::Raster, &[("show", "albedo"), ("fake", "as-taught")]);
        assert_eq!([traced.label(), fake.label()], ["Albedo by rays", "Albedo of the fake"]);
        let coarse: [&[(&str, &str)]; 2] = [&[("segments", "8"), ("shading", "phong"), ("fake", "as-taught")], &[]];
        assert_eq!(maps("normal", coarse), ["Normals of the fake, segments 8", "Normals of the fake, segments 100"]);
        let shown = [("show", "depth"), ("estimator", "uniform"), ("bounces", "0"), ("spp", "4")];
        let rays = labels("whitted", TechniqueName::Path, [&shown, &shown[..1]]);
        assert_eq!(rays, ["Depths by rays, 4 spp", "Depths by rays, 256 spp"], "light tells them not apart");
        let picture = labels("whitted", TechniqueName::Raster, [&[("show", "shadow-map"), ("shininess", "5")], &[]]);
        assert_eq!(picture, ["Shadow map of the fake, fair", "Fake, fair"]);
    }
}
