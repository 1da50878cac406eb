//! A picture whose records are read, to make it again or to judge it: whether its scene is still the one that it shows.

use crate::cli::RenderArgs;
use crate::ruler::made_before;
use anyhow::ensure;
use scene::edit::CannotEdit;
use scene::{Scene, SceneError, SceneHash};
use std::path::{Path, PathBuf};
use technique::{Denoiser, Shot};

/// A picture that says how it was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Original {
    /// The picture whose records these are.
    pub file: PathBuf,
    /// Its scene as it was read then; `None` of a picture from before this was kept.
    pub scene: Option<SceneHash>,
    /// How much of it is of earlier views of a window, if some is.
    pub earlier_views: Option<String>,
    /// The network that has denoised it, and the hash of the weights that it had.
    pub weights: Option<(Denoiser, String)>,
    /// Samples per pixel of the parts by which they are trusted, or that are layers.
    pub halves: Option<[u32; 2]>,
    /// What has taken its noise away that no option asks for.
    pub filter: Option<String>,
}

impl RenderArgs {
    /// Opens the scene, changed and seen as the options say.
    ///
    /// # Errors
    /// As [`Seen::of`](super::Seen::of).
    pub fn shot(&self) -> anyhow::Result<Shot> {
        self.seen.of(&self.scene).map_err(|fault| match (&self.original, fault.downcast_ref()) {
            (Some(original), Some(SceneError::Read { .. } | SceneError::Unknown { .. })) => fault.context(format!(
                "the scene of {} is not found; run this in the folder where it was made",
                image_file::shown(&original.file)
            )),
            (Some(original), None) if fault.is::<CannotEdit>() => {
                fault.context(format!("the scene of {} has become another", image_file::shown(&original.file)))
            }
            _ => fault,
        })
    }

    /// Says so where the scene is no longer the one of the picture that is made again, or where that cannot be told.
    pub fn tell_of_another_scene(&self, now: &Scene) {
        if let Some((file, then)) = self.kept_scene()
            && self.differs(then, now)
        {
            note!(
                "note: the scene has changed since {} was made; this is another picture: {}",
                image_file::shown(file),
                image_file::escaped(&self.scene)
            );
        }
    }

    /// Says so where the picture will be another one by itself.
    pub fn tell_of_what_is_not_made_again(&self) {
        self.tell_of_earlier_views();
        self.tell_of_other_weights();
        if let Some(Original { file, filter: Some(filter), .. }) = &self.original {
            let (file, filter) = (image_file::shown(file), image_file::escaped(filter));
            note!("note: {file} was denoised by visavis denoise ({filter}), which this does not do again");
        }
    }

    /// After how many samples the parts of so many meet, where the picture's did.
    pub fn parts_meet_at(&self, spp: u32) -> Option<u32> {
        let [first, later] = self.original.as_ref()?.halves?;
        (first.checked_add(later)? == spp).then_some(first)
    }

    /// Earlier views of a window, which nobody makes again.
    fn tell_of_earlier_views(&self) {
        if let Some(Original { file, earlier_views: Some(counts), .. }) = &self.original {
            let counts = image_file::escaped(counts);
            note!("note: {} had {counts}", image_file::shown(file));
        }
    }

    /// Weights that the picture's denoiser has learnt since.
    fn tell_of_other_weights(&self) {
        let Some(Original { file, weights: Some((denoiser, then)), .. }) = &self.original else { return };
        let now = self.pane.in_use().denoise().denoiser;
        if now == *denoiser && now.weights().is_some_and(|now| now != *then) {
            let file = image_file::shown(file);
            note!("note: {} has other weights than when {file} was made; this is another picture", now.name());
        }
    }

    /// Whether the reference of the scene is still the one of the picture. Numbers of the fake do not change it.
    ///
    /// # Errors
    /// If it is not.
    pub fn check_truth(&self, now: &Scene) -> anyhow::Result<()> {
        let Some((file, then)) = self.kept_scene() else { return Ok(()) };
        ensure!(
            then.has_the_truth_of(&now.as_read),
            "the scene has changed since {} was made, and has another reference; bring back the scene as it was, or name a \
             picture to compare with: {}",
            image_file::shown(file),
            image_file::escaped(&self.scene)
        );
        if self.differs(then, now) {
            note!(
                "note: the fake's numbers have changed since {} was made: {}",
                image_file::shown(file),
                image_file::escaped(&self.scene)
            );
        }
        Ok(())
    }

    /// The picture and its scene; says so where it has none.
    fn kept_scene(&self) -> Option<(&Path, &SceneHash)> {
        let Original { file, scene, .. } = self.original.as_ref()?;
        if scene.is_none() {
            note!("note: {}", made_before(file));
        }
        scene.as_ref().map(|then| (file.as_path(), then))
    }

    /// Whether what the picture depends on has changed.
    fn differs(&self, then: &SceneHash, now: &Scene) -> bool {
        !then.has_the_truth_of(&now.as_read) || (self.pane.technique.reads_stand_ins() && *then != now.as_read)
    }
}
