//! Where pictures are filtered: on the graphics device that traces them, else on the processor, and there too
//! where the device fails.

use crate::backend::threads_name;
use crate::{Backend, Renderer};
use denoise::gpu::GpuATrous;
use denoise::gpu::unet::GpuUnet;
use denoise::{DenoiseError, Network};
use film::Image;
use gpu::Gpu;
use std::cell::OnceCell;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Filters on a graphics device: compiled when they are first asked for, by whoever asks, and kept as long as the device.
pub struct DeviceFilters {
    gpu: Gpu,
    a_trous: OnceLock<Result<GpuATrous, DenoiseError>>,
    /// The network that was asked for last: two would take twice the memory.
    network: Mutex<Option<Compiled>>,
}

/// A network on the device, by the hash of its weights.
struct Compiled {
    hash: String,
    network: Result<Arc<GpuUnet>, DenoiseError>,
}

impl DeviceFilters {
    /// Those of any device, even of one that the processor plays.
    pub fn on(gpu: &Gpu) -> Self {
        DeviceFilters { gpu: gpu.clone(), a_trous: OnceLock::new(), network: Mutex::default() }
    }

    /// Those of a device that is faster than the processor: which plays no device as fast as it filters by itself (a-trous
    /// five times slower, the networks more).
    pub fn of(gpu: &Gpu) -> Option<Self> {
        (!gpu.is_software()).then(|| DeviceFilters::on(gpu))
    }

    pub(crate) fn a_trous(&self) -> Result<&GpuATrous, DenoiseError> {
        self.a_trous.get_or_init(|| GpuATrous::new(&self.gpu)).as_ref().map_err(Clone::clone)
    }

    pub(crate) fn unet(&self, network: &Network) -> Result<Arc<GpuUnet>, DenoiseError> {
        let mut kept = self.network.lock().unwrap_or_else(PoisonError::into_inner);
        kept.take_if(|compiled| compiled.hash != network.hash());
        let compile = || GpuUnet::new(&self.gpu, network).map(Arc::new).map_err(DenoiseError::from);
        kept.get_or_insert_with(|| Compiled { hash: network.hash(), network: compile() }).network.clone()
    }

    /// Gives back the memory of networks, which nobody asks for now.
    pub(crate) fn rest(&self) {
        *self.network.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// What filters a picture, and has.
pub struct Filters<'a> {
    device: Option<&'a DeviceFilters>,
    /// Why the device does not, where it should.
    refusal: OnceCell<Arc<str>>,
    /// Set once the device has filtered something.
    used: OnceCell<()>,
}

impl<'a> Filters<'a> {
    /// The processor alone, whatever devices there are.
    pub fn on_the_processor() -> Self {
        Filters::first_on(None)
    }

    /// This device as far as it goes, if there is one.
    pub fn first_on(device: Option<&'a DeviceFilters>) -> Self {
        Filters { device, refusal: OnceCell::new(), used: OnceCell::new() }
    }

    /// Why the device does not filter, where it should: one line.
    pub fn refusal(&self) -> Option<&Arc<str>> {
        self.refusal.get()
    }

    /// What has filtered, by name; of the processor the current rayon pool.
    pub fn made_by(&self) -> String {
        match self.device.filter(|_| self.used.get().is_some()) {
            Some(device) if self.refusal.get().is_none() => device.gpu.describe(),
            Some(device) => format!("{}, then {}", device.gpu.describe(), threads_name()),
            None => threads_name(),
        }
    }

    /// What the device makes, else what the processor does: once it has failed at a picture it is not asked again.
    pub(crate) fn run(
        &self,
        on_device: impl FnOnce(&DeviceFilters) -> Result<Image, DenoiseError>,
        on_the_processor: impl FnOnce() -> Result<Image, DenoiseError>,
    ) -> Result<Image, DenoiseError> {
        let Some(device) = self.device.filter(|_| self.refusal.get().is_none()) else { return on_the_processor() };
        match on_device(device) {
            Err(DenoiseError::Device(why)) => {
                let _ = self.refusal.set(why.into());
                on_the_processor()
            }
            done => {
                let _ = self.used.set(());
                done
            }
        }
    }
}

impl Renderer {
    /// Filters of the device that makes its films.
    pub(crate) fn device_filters(&self) -> Option<&DeviceFilters> {
        match &self.backend {
            Backend::Cpu(_) => None,
            Backend::Gpu(gpu_backend) => gpu_backend.filters(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Accumulation, DenoiseSettings, Denoised, Denoiser, Frame, Pacing, Threads, Watch};
    use film::{Features, Vec3};
    use pathtrace::PathSettings;
    use std::time::Duration;

    const SIZE: (u32, u32) = (24, 16);

    struct Patient;

    impl Watch for Patient {
        fn ends_soon(&self, _spp: u32) -> bool {
            false
        }

        fn pacing(&self, _spent: Duration) -> Pacing {
            Pacing { pass: Duration::from_secs(1), show: Duration::from_secs(60), growth: 4 }
        }

        fn show(&self, _frame: Frame) {}
    }

    const A_TROUS: DenoiseSettings = DenoiseSettings { denoiser: Denoiser::ATrous, ..DenoiseSettings::OFF };

    /// A denoised picture by a renderer on this backend.
    fn denoised(scene: &Arc<scene::Scene>, backend: Backend) -> Denoised {
        let mut renderer = Renderer::new(scene.clone(), backend, Arc::new(Threads::all()));
        let blank = Accumulation::blank(SIZE).unwrap();
        let wanted = (&PathSettings::default().into(), 4);
        renderer.finish(blank, &scene.camera, wanted, A_TROUS, &Patient).denoised.unwrap().unwrap()
    }

    #[test]
    fn films_of_a_device_are_filtered_there_unless_the_processor_plays_it() {
        let scene = Arc::new(scene::builtin::named("cornell").unwrap());
        let gpu = Gpu::headless().unwrap();
        let usual = denoised(&scene, Backend::on_the_device(&gpu, &scene).unwrap());
        assert_eq!(usual.made_by == gpu.describe(), !gpu.is_software(), "{}", usual.made_by);
        let Backend::Gpu(mut backend) = Backend::on_the_device(&gpu, &scene).unwrap() else { panic!("no device") };
        backend.filters = Some(DeviceFilters::on(&gpu));
        let there = denoised(&scene, Backend::Gpu(backend));
        assert_eq!((there.made_by, there.refused), (gpu.describe(), None));
        let pairs = there.image.radiances().iter().zip(usual.image.radiances());
        let most = pairs.map(|(a, b)| (*a - *b).abs().max_element() / b.max_element().max(1e-3));
        // guides come in sixteen bits a component
        assert!(most.fold(0.0, f32::max) < 1e-3);
    }

    /// Then the picture is shown as it is, with the reason.
    #[test]
    fn where_there_is_no_memory_for_features_nothing_is_denoised_and_it_says_so() {
        let scene = Arc::new(scene::builtin::named("cornell").unwrap());
        let renderer = Renderer::on_the_processor(scene, Arc::new(Threads::all()));
        let mut accumulation = Accumulation::blank(SIZE).unwrap();
        assert!(renderer.denoised(&accumulation, None, A_TROUS, &|| false).is_none(), "there are none yet");
        accumulation.features_fault = Some(DenoiseError::Memory(1));
        let denoised = |settings| renderer.denoised(&accumulation, None, settings, &|| false);
        assert!(matches!(denoised(A_TROUS), Some(Err(DenoiseError::Memory(1)))));
        assert!(denoised(DenoiseSettings::OFF).is_none());
    }

    #[test]
    fn what_a_device_refuses_the_processor_filters_and_it_says_why() {
        let pixels = (SIZE.0 * SIZE.1) as usize;
        let image = Image::new(SIZE.0, SIZE.1, (0..pixels).map(|i| Vec3::splat((i % 7) as f32)).collect::<Vec<_>>());
        let image = image.unwrap();
        let albedo = vec![Vec3::ONE; pixels];
        let features = Features::new(SIZE, albedo.clone(), albedo, vec![1.0; pixels]).unwrap();
        let gpu = Gpu::headless().unwrap();
        let device = DeviceFilters::on(&gpu);
        let apply = |filters: &Filters| Denoiser::ATrous.apply(&image, &features, None, filters, &|| false).unwrap();
        let expected = apply(&Filters::on_the_processor());
        let well = Filters::first_on(Some(&device));
        assert!(apply(&well) != expected, "rounding tells who did it");
        gpu.device.destroy();
        gpu.remember("it was unplugged".into());
        let lost = Filters::first_on(Some(&device));
        assert_eq!(apply(&lost), expected);
        assert!(lost.refusal().is_some_and(|why| why.ends_with(": it was unplugged")), "{:?}", lost.refusal());
        let made_by = [well.made_by(), lost.made_by()];
        assert_eq!(made_by, [gpu.describe(), threads_name()]);
    }
}
