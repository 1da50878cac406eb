//! The workers of one pane, made when the pane first asks for their technique.

use super::external::{ExternalJob, ExternalWorker};
use super::fake::FakeWorker;
use super::post_process::PostProcess;
use super::rays::{RayNews, RayWorker};
use super::{Job, Order, Wake};
use crate::model::{PaneId, PaneSource};
use anyhow::Context;
use gpu::Gpu;
use std::sync::Arc;
use technique::{Adapters, Technique, Threads};

/// One pane's workers; dropping it ends their threads.
pub struct PaneWorkers {
    pane: PaneId,
    gpu: Gpu,
    adapters: Adapters,
    threads: Arc<Threads>,
    post_process: Arc<PostProcess>,
    wake: Wake,
    fake: Option<FakeWorker>,
    rays: Option<RayWorker>,
    external: Option<ExternalWorker>,
    /// Where another program's picture comes from, while one is listened to.
    listened_to: Option<PaneSource>,
    held: bool,
}

impl PaneWorkers {
    /// A pane without workers yet. `gpu` is the window's, `adapters` and `threads` can trace rays.
    pub fn new(
        pane: PaneId,
        gpu: Gpu,
        (adapters, threads): (Adapters, Arc<Threads>),
        post_process: Arc<PostProcess>,
        wake: Wake,
    ) -> Self {
        let (fake, rays, external, listened_to) = (None, None, None, None);
        PaneWorkers { pane, gpu, adapters, threads, post_process, wake, fake, rays, external, listened_to, held: false }
    }

    /// Draws the fake on another device of the window's from now on.
    pub fn move_to(&mut self, gpu: Gpu) {
        (self.gpu, self.fake) = (gpu, None);
    }

    /// Asks for a picture; whatever this pane was making stops. Settings that cannot be rendered are told in the picture's
    /// place.
    pub fn submit(&mut self, technique: Technique, source: &PaneSource, order: Order) {
        if *source != PaneSource::Made {
            return self.show_external(source.clone(), order);
        }
        self.listen_to_nobody();
        let begun = match technique {
            Technique::Traced(settings) if settings.integrator.check().is_err() => {
                self.rest();
                settings.integrator.check().map_err(anyhow::Error::from)
            }
            Technique::Fake(settings) => {
                self.rays.iter_mut().for_each(RayWorker::cancel);
                self.fake().map(|worker| worker.submit(Job { settings, order: order.clone() }))
            }
            Technique::Traced(settings) => {
                self.fake.iter().for_each(FakeWorker::cancel);
                self.rays().map(|worker| worker.submit(Job { settings, order: order.clone() }))
            }
        };
        if let Err(fault) = begun {
            self.post_process.report(self.pane, order, format!("{fault:#}"));
        }
    }

    /// Shows what another program makes.
    fn show_external(&mut self, source: PaneSource, order: Order) {
        self.fake.iter().for_each(FakeWorker::cancel);
        self.rays.iter_mut().for_each(RayWorker::cancel);
        self.listened_to = Some(source.clone());
        match self.external() {
            Ok(worker) => worker.submit(ExternalJob { source, order }),
            Err(fault) => self.post_process.report(self.pane, order, format!("{fault:#}")),
        }
    }

    /// Measures the fake that was drawn last once more.
    pub fn measure_again(&self) {
        self.fake.iter().for_each(FakeWorker::measure_again);
    }

    /// Stops whatever this pane was making.
    pub fn rest(&mut self) {
        self.fake.iter().for_each(FakeWorker::cancel);
        self.rays.iter_mut().for_each(RayWorker::cancel);
        self.listen_to_nobody();
    }

    /// Makes nothing while the pane is not seen. What another program sends is still taken.
    pub fn rest_unseen(&mut self) {
        self.fake.iter().for_each(FakeWorker::cancel);
        self.rays.iter_mut().for_each(RayWorker::cancel);
        if let Some((worker, source)) = self.external.as_ref().zip(self.listened_to.clone()) {
            worker.keep(source);
        }
    }

    /// Follows what an unseen pane's picture comes from: closes what was listened to where that is now another.
    pub fn follow_unseen(&mut self, source: Option<&PaneSource>) {
        if self.listened_to.as_ref() != source {
            self.listen_to_nobody();
        }
    }

    fn listen_to_nobody(&mut self) {
        self.external.iter().for_each(ExternalWorker::cancel);
        self.listened_to = None;
    }

    /// What rays wait for now, if that has changed since the last call.
    pub fn news(&self) -> Option<RayNews> {
        self.rays.as_ref()?.news()
    }

    /// Holds the tracing of rays, or lets it go on.
    pub fn hold(&mut self, held: bool) {
        self.held = held;
        self.rays.iter().for_each(|worker| worker.hold(held));
    }

    fn fake(&mut self) -> anyhow::Result<&FakeWorker> {
        if self.fake.is_none() {
            let worker =
                FakeWorker::start(self.pane, self.gpu.clone(), self.threads.clone(), self.post_process.clone());
            let worker = worker.context("no thread for the fake")?;
            self.fake = Some(worker);
        }
        self.fake.as_ref().context("no thread for the fake")
    }

    fn external(&mut self) -> anyhow::Result<&ExternalWorker> {
        if self.external.is_none() {
            let worker = ExternalWorker::start(self.pane, self.post_process.clone());
            self.external = Some(worker.context("no thread for pictures of other programs")?);
        }
        self.external.as_ref().context("no thread for pictures of other programs")
    }

    fn rays(&mut self) -> anyhow::Result<&mut RayWorker> {
        if self.rays.is_none() {
            let tracers = (self.adapters.clone(), self.threads.clone());
            let worker = RayWorker::start(self.pane, tracers, self.post_process.clone(), self.wake.clone());
            let worker = worker.context("no thread for tracing rays")?;
            worker.hold(self.held);
            self.rays = Some(worker);
        }
        self.rays.as_mut().context("no thread for tracing rays")
    }
}
