//! The device that rasteriser and GPU path tracer share: which adapter is taken and why, how WGSL is composed from
//! plain files, and how data gets there and back. Nothing here knows what is drawn.
//!
//! A fault of the device never panics: it is kept, and [`Gpu::fault`] tells it.

mod adapter;
pub mod compute;
mod error;
mod fault_injection;
pub mod readback;
pub mod shared_shaders;
pub mod upload;
pub mod waiting;
pub mod wgsl;

pub use adapter::{AdapterReport, Rank, choose};
pub use error::GpuError;
pub use fault_injection::FaultInjection;
pub use wgpu;

use std::sync::{Arc, Mutex, PoisonError};

/// What is used where an adapter has it, and done without where it has not: times of passes, and numbers
/// of half the size.
const WELCOME: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::SHADER_F16);

/// A graphics device with its queue. Clones share it.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// Where the adapter came from; surfaces are made from it.
    pub instance: wgpu::Instance,
    /// The physical or software device.
    pub adapter: wgpu::Adapter,
    /// The logical device, with every limit that the adapter offers, and what else is welcome.
    pub device: wgpu::Device,
    /// Where work is submitted.
    pub queue: wgpu::Queue,
    fault: Arc<Mutex<Option<String>>>,
}

/// An instance that can present on `display`, or that only renders where there is none. The environment variable
/// `WGPU_BACKEND` (`vulkan`, `gl`, ...) restricts it.
pub fn new_instance(display: Option<Box<dyn wgpu::wgt::WgpuHasDisplayHandle>>) -> wgpu::Instance {
    wgpu::Instance::new(match display {
        Some(display) => wgpu::InstanceDescriptor::new_with_display_handle_from_env(display),
        None => wgpu::InstanceDescriptor::new_without_display_handle_from_env(),
    })
}

impl Gpu {
    /// The best device of this computer, without a window.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] if there is none, [`GpuError::Device`] if it refuses.
    pub fn headless() -> Result<Gpu, GpuError> {
        Gpu::headless_through(wgpu::Backends::all())
    }

    /// As [`Gpu::headless`], through one of these interfaces.
    ///
    /// # Errors
    /// As [`Gpu::headless`].
    pub fn headless_through(interfaces: wgpu::Backends) -> Result<Gpu, GpuError> {
        let instance = new_instance(None);
        let mut adapters = adapter::all(&instance);
        adapters.retain(|adapter| interfaces.contains(adapter.get_info().backend.into()));
        Gpu::open(instance, adapters, GpuError::NoAdapter)
    }

    /// As [`Gpu::headless`], on the adapter that calls itself `described`, see [`AdapterReport::describe`].
    ///
    /// # Errors
    /// [`GpuError::NoSuchAdapter`] if none does, [`GpuError::Device`] if it refuses.
    pub fn headless_on(described: &str) -> Result<Gpu, GpuError> {
        let instance = new_instance(None);
        let mut adapters = adapter::all(&instance);
        let found = adapter::report(&adapters).iter().position(|adapter| adapter.describe() == described);
        let only = found.map(|index| adapters.swap_remove(index));
        Gpu::open(instance, only.into_iter().collect(), GpuError::NoSuchAdapter(described.to_owned()))
    }

    /// Every device of this computer that opens, the best first, without a window: for tests that must hold on all of
    /// them. Drivers list adapters that then refuse, as that of a card without a display does through OpenGL.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] if there is none, [`GpuError::Device`] of the best if all refuse.
    pub fn each() -> Result<Vec<Gpu>, GpuError> {
        let instance = new_instance(None);
        let mut adapters = adapter::all(&instance);
        adapters.sort_by_key(|adapter| std::cmp::Reverse(Rank::of(&adapter.get_info())));
        if adapters.is_empty() {
            return Err(GpuError::NoAdapter);
        }
        let open = |adapter| Gpu::open(instance.clone(), vec![adapter], GpuError::NoAdapter);
        let (opened, refused): (Vec<_>, Vec<_>) = adapters.into_iter().map(open).partition(Result::is_ok);
        if opened.is_empty() { refused } else { opened }.into_iter().collect()
    }

    /// The best device that can present on `surface`, which `instance` made, and every adapter there is, whether it can
    /// or not.
    ///
    /// # Errors
    /// [`GpuError::NoAdapterForWindow`] if there is none, [`GpuError::Device`] if it refuses.
    pub fn for_surface(
        instance: wgpu::Instance,
        surface: &wgpu::Surface<'_>,
    ) -> Result<(Gpu, Vec<AdapterReport>), GpuError> {
        let mut adapters = adapter::all(&instance);
        let report = adapter::report(&adapters);
        adapters.retain(|adapter| adapter.is_surface_supported(surface));
        Ok((Gpu::open(instance, adapters, GpuError::NoAdapterForWindow)?, report))
    }

    /// Every adapter of this computer in the order in which they answer, and which one [`Gpu::headless`] takes.
    pub fn adapters() -> Vec<AdapterReport> {
        adapter::report(&adapter::all(&new_instance(None)))
    }

    fn open(instance: wgpu::Instance, mut adapters: Vec<wgpu::Adapter>, none: GpuError) -> Result<Gpu, GpuError> {
        let infos: Vec<_> = adapters.iter().map(wgpu::Adapter::get_info).collect();
        let adapter = adapters.swap_remove(choose(&infos).ok_or(none)?);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("visavis"),
            required_limits: adapter.limits(),
            required_features: adapter.features() & WELCOME,
            ..wgpu::DeviceDescriptor::default()
        };
        let refused = |source| GpuError::Device {
            adapter: adapter::describe(&adapter.get_info()),
            why: error::one_line(&source),
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(refused)?;
        let fault = Arc::new(Mutex::new(None));
        remember_faults(&device, &fault);
        Ok(Gpu { instance, adapter, device, queue, fault })
    }

    /// Whether the processor plays the graphics device.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Whether both are clones of one device. What wgpu compares are numbers that each instance gives anew.
    pub fn is_same_device(&self, other: &Gpu) -> bool {
        Arc::ptr_eq(&self.fault, &other.fault)
    }

    /// Name and interface, as in "llvmpipe (LLVM 19.1, 256 bits), Vulkan".
    pub fn describe(&self) -> String {
        adapter::describe(&self.adapter.get_info())
    }

    /// The first thing that went wrong outside of [`Gpu::checked`], or the loss of the device: one line.
    pub fn fault(&self) -> Option<String> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Takes down that this device has failed, where that was noticed in other ways than its own.
    pub fn remember(&self, why: String) {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(why);
    }

    /// Runs `work` and turns what the device objects to into an error. `what` names the work in the message.
    ///
    /// # Errors
    /// [`GpuError::Refused`] with the device's objection.
    pub fn checked<T>(&self, what: &str, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let filters = [wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal];
        let mut scopes: Vec<_> = filters.into_iter().map(|filter| self.device.push_error_scope(filter)).collect();
        let done = work();
        let mut objection = None;
        while let Some(scope) = scopes.pop() {
            objection = pollster::block_on(scope.pop()).or(objection);
        }
        match objection {
            Some(why) => Err(GpuError::Refused { what: what.to_owned(), why: error::one_line(&why) }),
            None => Ok(done),
        }
    }

    /// Refuses a picture or map that this device can't hold. `what` names it in the message.
    ///
    /// # Errors
    /// [`GpuError::Empty`] for a side of 0, [`GpuError::TooLarge`] beyond the device's limit.
    pub fn check_size(&self, what: &str, width: u32, height: u32) -> Result<(), GpuError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        let what = what.to_owned();
        if width == 0 || height == 0 {
            Err(GpuError::Empty { what, width, height })
        } else if width.max(height) > limit {
            Err(GpuError::TooLarge { what, width, height, limit, adapter: self.describe() })
        } else {
            Ok(())
        }
    }
}

fn remember_faults(device: &wgpu::Device, fault: &Arc<Mutex<Option<String>>>) {
    let keep = |fault: &Mutex<Option<String>>, message: String| {
        fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
    };
    let uncaptured = Arc::clone(fault);
    device.on_uncaptured_error(Arc::new(move |why: wgpu::Error| keep(&uncaptured, error::one_line(&why))));
    let lost = Arc::clone(fault);
    device.set_device_lost_callback(move |reason, message| {
        if reason != wgpu::DeviceLostReason::Destroyed {
            keep(&lost, format!("the graphics device was lost: {}", error::one_line(&message)));
        }
    });
}
