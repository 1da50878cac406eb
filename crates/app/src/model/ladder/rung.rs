//! A rung of the ladder: what is repaired there, what there is to say about it, and how it is made.

use raster::{Fake, RefractedAt, Repair, Repairs};
use scene::Scene;
use technique::{PaneSettings, TechniqueName};

/// In which order defects are repaired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// That in which light meets them.
    #[default]
    Light,
    /// First what takes most error away for its milliseconds, of what is left.
    BestFirst,
}

impl Order {
    /// Both, the usual one first.
    pub const ALL: [Order; 2] = [Order::Light, Order::BestFirst];

    /// On the command line, and in a session's file.
    pub fn name(self) -> &'static str {
        match self {
            Order::Light => "light",
            Order::BestFirst => "best-first",
        }
    }
}

/// A step towards the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Rung {
    /// What the tutorial's viewer draws.
    #[default]
    AsTaught,
    /// The same with glass that bends light in every pixel, not at vertices alone.
    Fragments,
    /// The same in light rather than bytes: the fair fake.
    Encoding,
    /// A defect of the fair fake less.
    Repair(Repair),
    /// Rays at mirrors and glass.
    Whitted,
    /// The truth as far as its samples go.
    Path,
}

impl Rung {
    /// How many there are.
    pub const COUNT: usize = Repair::ALL.len() + 5;

    /// All of them, from the bottom to the top, in the order in which light meets the defects.
    pub fn all() -> impl DoubleEndedIterator<Item = Rung> + Clone {
        let repairs = Repair::ALL.into_iter().map(Rung::Repair);
        let taught = [Rung::AsTaught, Rung::Fragments, Rung::Encoding];
        taught.into_iter().chain(repairs).chain([Rung::Whitted, Rung::Path])
    }

    /// Which of [`Rung::all`] it is, from 0.
    pub fn place(self) -> usize {
        match self {
            Rung::AsTaught => 0,
            Rung::Fragments => 1,
            Rung::Encoding => 2,
            Rung::Repair(repair) => 3 + repair as usize,
            Rung::Whitted => Rung::COUNT - 2,
            Rung::Path => Rung::COUNT - 1,
        }
    }

    /// The name in tables and of its picture's file.
    pub fn name(self) -> &'static str {
        match self {
            Rung::AsTaught => "as-taught",
            Rung::Fragments => "fragments",
            Rung::Encoding => "encoding",
            Rung::Repair(repair) => repair.name(),
            Rung::Whitted => "whitted",
            Rung::Path => "path",
        }
    }

    /// What is repaired, in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Rung::AsTaught => "The fake as taught",
            Rung::Fragments => "Bent in every pixel",
            Rung::Encoding => "Light in place of bytes",
            Rung::Repair(repair) => repair.row().title,
            Rung::Whitted => "Whitted: trees of rays",
            Rung::Path => "Path tracing",
        }
    }

    /// What is wrong without it, and what stays wrong.
    pub fn text(self) -> &'static str {
        match self {
            Rung::AsTaught => "The tutorial's viewer, number for number: everything below is wrong with it.",
            Rung::Fragments => {
                "The viewer's material bends light at vertices, and between them directions are interpolated. A fragment shader of one's \
                 own bends it in every pixel: of a hundred segments that is hardly seen, of eight it is."
            }
            Rung::Encoding => {
                "Its light is clamped and its bytes go to the screen as they are, with ambient light that someone has chosen. Instead \
                 light is linear and without bound, sun and sky have the truth's units, and what is shown is encoded."
            }
            Rung::Repair(repair) => repair.row().text,
            Rung::Whitted => {
                "No maps: rays look for what mirrors and glass show, and for shadows. Still no light from one matt surface on another, \
                 and no light through glass on matt surfaces."
            }
            Rung::Path => {
                "All light, by chance: what is left of the error is noise, and halves with four times the samples."
            }
        }
    }

    /// Where the tutorial speaks of it.
    pub fn slide(self) -> &'static str {
        match self {
            Rung::AsTaught => "Task 1: Faking Whitted with rasterisation",
            Rung::Fragments => "Other possible solutions: customised shaders",
            Rung::Encoding => "Task 1 b: What went wrong here?",
            Rung::Repair(repair) => repair.row().slide,
            Rung::Whitted => "Task 1 c: Whitted-style ray tracing",
            Rung::Path => "Task 2: Monte Carlo path tracing",
        }
    }

    /// What `scene` lacks for the rung to be one, after "no".
    pub fn missing_in(self, scene: &Scene) -> Option<&'static str> {
        match self {
            Rung::Fragments if !scene.needs().dielectric => Some("glass"),
            Rung::Repair(repair) => (repair.row().missing_in)(scene),
            _ => None,
        }
    }
}

/// The fake as taught, with glass that bends light there.
pub fn as_taught(refracted: RefractedAt) -> PaneSettings {
    let mut pane = PaneSettings::of(TechniqueName::Raster);
    (pane.fake.fake, pane.fake.knobs.refracted) = (Fake::AsTaught, refracted);
    pane
}

/// The fair fake with these repairs.
pub fn repaired(repairs: Repairs) -> PaneSettings {
    let mut pane = PaneSettings::of(TechniqueName::Raster);
    (pane.fake.fake, pane.fake.repairs) = (Fake::Fair, repairs);
    pane
}

/// The repairs that have something to repair in this scene, and what it lacks for the other rungs.
pub fn repairs_of(scene: &Scene) -> (Vec<Repair>, Vec<(Rung, &'static str)>) {
    let useful = Repair::ALL.into_iter().filter(|repair| (repair.row().missing_in)(scene).is_none());
    let idle = Rung::all().filter_map(|rung| Some((rung, rung.missing_in(scene)?)));
    (useful.collect(), idle.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rung_has_its_place_and_a_name_of_its_own() {
        let mut names: Vec<_> = Rung::all().map(Rung::name).collect();
        assert!(Rung::all().enumerate().all(|(place, rung)| rung.place() == place) && names.len() == Rung::COUNT);
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Rung::COUNT);
    }

    #[test]
    fn a_scene_without_glass_and_mirror_has_other_rungs_than_one_with_both() {
        let rungs = |name: &str| repairs_of(&scene::builtin::named(name).expect("a built-in scene"));
        // no lamp, and one matt surface alone
        let lit = [Repair::AreaLights, Repair::ReflectiveShadowMap, Repair::IrradianceProbes];
        let of_whitted = Repair::ALL.into_iter().filter(|repair| !lit.contains(repair));
        assert_eq!(rungs("whitted").0, of_whitted.collect::<Vec<_>>());
        let (useful, idle) = rungs("cornell");
        assert_eq!(useful, [&[Repair::Antialiasing, Repair::SoftShadows][..], &lit].concat());
        assert!(
            idle.contains(&(Rung::Repair(Repair::Mirrors), "mirror")) && idle.contains(&(Rung::Fragments, "glass"))
        );
        assert_eq!(useful.len() + idle.len(), Repair::ALL.len() + 1);
    }
}
