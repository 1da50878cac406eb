//! What pictures are called beside each other: by their techniques, or by the settings in which they differ.

use crate::settings::all_of_panes;
use crate::{PaneSettings, Technique};
use pathtrace::Integrator;
use raster::Show;
use scene::Scene;

impl Technique {
    /// Its name with the setting that says most: "Fake, fair", "Path tracing, light", "Whitted, depth 8".
    pub fn label(&self) -> String {
        let name = self.name().in_full();
        match self {
            Technique::Fake(fake) => match fake.show {
                Show::Picture => format!("{name}, {}", fake.fake.name()),
                Show::CubeFaces => format!("Cube faces of the fake, {}", fake.fake.name()),
                Show::ShadowMap => format!("Shadow map of the fake, {}", fake.fake.name()),
            },
            Technique::Traced(traced) => match traced.integrator {
                Integrator::Path(path) => format!("{name}, {}", path.estimator.name()),
                Integrator::Whitted(tree) => format!("{name}, depth {}", tree.depth),
                Integrator::Normals(normals) => format!("{name}, {} axes", normals.space.name()),
            },
        }
    }

    /// What tells it from another picture of `scene`: of one technique all settings that differ, as "Path tracing,
    /// 0 bounces" beside "Path tracing, 1 bounce"; else [`Technique::label`].
    pub fn label_beside(&self, other: &Technique, scene: &Scene) -> String {
        let differing = self.settings_unlike(other, scene);
        if differing.is_empty() {
            return self.label();
        }
        format!("{}, {}", self.name().in_full(), differing.join(", "))
    }

    /// Its values of the settings that change pictures of `scene` and have another value in `other`.
    fn settings_unlike(&self, other: &Technique, scene: &Scene) -> Vec<String> {
        if self.name() != other.name() {
            return Vec::new();
        }
        let panes = [self, other].map(|technique| PaneSettings::from(*technique));
        let used = all_of_panes().filter(|row| row.is_of(self.name()) && row.needs.missing_in(scene).is_none());
        let unlike = used.filter_map(|row| {
            let [own, others] = panes.map(|pane| (row.get)(&pane).or_else(|| (row.own)(scene)));
            (own != others).then_some(row.brief(own?))
        });
        unlike.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Value, of_panes};
    use crate::{FakeSettings, TechniqueName};
    use raster::Fake;

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
        assert_eq!(path.label_beside(&fake, &scene), "Path tracing, light");
        assert_eq!(whitted.label_beside(&path, &scene), "Whitted, depth 8");
        assert_eq!(normals.label_beside(&path, &scene), "Normals, world axes");
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
    fn a_map_of_the_fake_is_called_by_its_name() {
        let map = FakeSettings { show: Show::ShadowMap, fake: Fake::AsTaught, ..FakeSettings::default() };
        assert_eq!(Technique::Fake(map).label(), "Shadow map of the fake, as-taught");
    }
}
