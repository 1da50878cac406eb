//! The figures of a report: of each picture against the reference, of A against B, and of the region alone.

use super::{LabReport, ReportedPicture};
use crate::model::{Against, CompareWith, PaneId};
use crate::ruler::{HeatMap, Noise, Pair};
use compare::{CompareError, ErrorMetric, Errors, PixelRect, errors, errors_within, finite_mean};
use film::Image;

/// How far one picture is from what it is held against.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Whose figures these are.
    pub of: PaneId,
    /// What it is held against.
    pub against: Against,
    /// Whether they are of the region alone.
    pub in_the_region: bool,
    /// The errors in linear radiance.
    pub errors: Errors,
    /// Mean LDR-FLIP, through the display transform.
    pub flip: f64,
}

/// Two pictures of the same pixels that show the scene, and what the second one is.
struct Held<'a> {
    of: &'a ReportedPicture,
    against: Against,
    judge: &'a Image,
}

impl LabReport {
    /// All figures: the whole pictures first, then their region.
    ///
    /// # Errors
    /// If there is no memory for FLIP.
    pub fn measured(&self) -> Result<Vec<Measured>, CompareError> {
        let region = self.session.comparison.region;
        let mut figures = Vec::new();
        for held in self.pairs() {
            let flip = ErrorMetric::Flip.of(&held.of.image, held.judge, &self.session.display)?;
            figures.push(self.figures(&held, &flip, None)?);
            let rect = region.map(|region| region.pixels(held.judge.size()));
            figures.extend(rect.map(|rect| self.figures(&held, &flip, Some(rect))).transpose()?);
        }
        figures.sort_by_key(|measured| measured.in_the_region);
        Ok(figures)
    }

    fn figures(&self, held: &Held, flip: &[f32], rect: Option<PixelRect>) -> Result<Measured, CompareError> {
        let image = &held.of.image;
        let of_reference = self.reference.as_ref().filter(|_| held.against == Against::Reference);
        let errors = match (of_reference, &rect) {
            (Some(reference), None) => reference.image.errors(image),
            (Some(reference), Some(rect)) => reference.image.errors_within(image, rect),
            (None, None) => errors(image, held.judge),
            (None, Some(rect)) => errors_within(image, held.judge, rect),
        }?;
        let flip = match &rect {
            None => finite_mean(flip).0,
            Some(rect) => finite_mean(&rect.of(flip, image.width()).copied().collect::<Vec<_>>()).0,
        };
        Ok(Measured { of: held.of.pane, against: held.against, in_the_region: rect.is_some(), errors, flip })
    }

    /// Whether a picture that is to be held against the reference cannot be, for the reference has all light.
    pub(super) fn shows_too_little(&self, picture: &ReportedPicture) -> bool {
        self.session.comparison.with == CompareWith::Reference && picture.shows_a_part_of_the_light()
    }

    /// Each picture against the reference, then A against B.
    fn pairs(&self) -> Vec<Held<'_>> {
        let shows = |picture: &&ReportedPicture| picture.provenance.technique.shows_the_scene();
        let pictures: Vec<&ReportedPicture> = self.pictures.iter().filter(shows).collect();
        let mut pairs = Vec::new();
        if let Some(reference) = &self.reference {
            let judge = &reference.image.image;
            // the reference has all light
            let judged = pictures.iter().filter(|of| of.provenance.technique.has_a_reference());
            pairs.extend(judged.map(|of| Held { of, against: Against::Reference, judge }));
        }
        let light = |picture: &ReportedPicture| picture.provenance.technique.light();
        if let [a, b] = pictures[..]
            && light(a) == light(b)
        {
            pairs.push(Held { of: a, against: Against::Pane(b.pane), judge: &b.image });
        }
        pairs.retain(|held| held.of.image.size() == held.judge.size());
        pairs
    }

    /// The maps of errors against the reference, or of A against B where there is none: all up to the same error, so that
    /// they can be compared by eye.
    ///
    /// # Errors
    /// If there is no memory for FLIP.
    pub(super) fn maps(&self) -> Result<Vec<(PaneId, Against, HeatMap)>, CompareError> {
        let pairs = self.mapped_pairs();
        let wish = self.session.comparison.map();
        let fitted = pairs.iter().map(|held| self.map(held, wish.held)).collect::<Result<Vec<_>, _>>()?;
        let end = fitted.iter().map(|(.., map)| map.scale.high).fold(f32::MIN_POSITIVE, f32::max);
        pairs.iter().map(|held| self.map(held, Some(end))).collect()
    }

    /// The map that the view shows, or the other pane's where there is none of it, under a scale of its own.
    ///
    /// # Errors
    /// If there is no memory for FLIP.
    pub(super) fn map_of_the_view(&self) -> Result<Option<(PaneId, Against, HeatMap)>, CompareError> {
        let wish = self.session.comparison.map();
        let mut pairs = self.mapped_pairs();
        let place = pairs.iter().position(|held| held.of.pane == wish.comparison.of).unwrap_or(0);
        (!pairs.is_empty()).then(|| self.map(&pairs.swap_remove(place), wish.held)).transpose()
    }

    /// Those against the reference, or A against B where there is none.
    fn mapped_pairs(&self) -> Vec<Held<'_>> {
        let mut pairs = self.pairs();
        if self.reference.is_some() {
            pairs.retain(|held| held.against == Against::Reference);
        }
        pairs
    }

    fn map(&self, held: &Held, end: Option<f32>) -> Result<(PaneId, Against, HeatMap), CompareError> {
        let noise_of_judge = match (held.against, &self.reference) {
            (Against::Reference, Some(reference)) => reference.image.noise_of_pixels(),
            _ => Noise::Unknown,
        };
        let own = if held.of.spp.is_some() { Noise::Unknown } else { Noise::None };
        let pair = Pair {
            names: [held.of.pane.name(), held.against.name()],
            images: [held.of.image.clone(), held.judge.clone()],
            noise: [own, noise_of_judge],
            display: self.session.display,
        };
        Ok((held.of.pane, held.against, HeatMap::of(&pair, self.session.comparison.metric, end)?))
    }
}
