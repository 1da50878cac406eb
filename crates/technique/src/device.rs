//! Where rays are traced: as the user wishes, and as it is then done.

use anyhow::Context;
use gpu::{AdapterReport, Gpu};

/// What the user wishes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// Where it is faster.
    #[default]
    Auto,
    /// By the processor.
    Cpu,
    /// By the graphics device.
    Gpu,
}

/// What rays can be traced by beside the processor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter {
    /// Name and interface.
    pub name: String,
    /// Whether the processor plays it.
    pub software: bool,
}

/// Every adapter of this computer, the best first.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Adapters(pub Vec<Adapter>);

impl Adapters {
    /// Those of a report.
    pub fn of(report: &[AdapterReport]) -> Self {
        let (best, others): (Vec<_>, Vec<_>) = report.iter().partition(|adapter| adapter.chosen);
        let one = |adapter: &AdapterReport| Adapter { name: adapter.describe(), software: adapter.software };
        Adapters(best.into_iter().chain(others).map(one).collect())
    }

    /// Whether the processor plays even the best.
    pub fn only_software(&self) -> bool {
        self.0.first().is_none_or(|best| best.software)
    }
}

/// What traces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Device {
    /// The processor.
    Cpu,
    /// The graphics device.
    Gpu,
}

impl DeviceChoice {
    /// All, the usual one first.
    pub const ALL: [DeviceChoice; 3] = [DeviceChoice::Auto, DeviceChoice::Cpu, DeviceChoice::Gpu];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            DeviceChoice::Auto => "auto",
            DeviceChoice::Cpu => "cpu",
            DeviceChoice::Gpu => "gpu",
        }
    }

    /// The device of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|device| device.name() == name)
    }

    /// What it is beside the best adapter: where the processor only plays the graphics device, it is faster as itself.
    pub fn beside(self, software_adapter: bool) -> Device {
        match self {
            DeviceChoice::Cpu => Device::Cpu,
            DeviceChoice::Auto if software_adapter => Device::Cpu,
            DeviceChoice::Auto | DeviceChoice::Gpu => Device::Gpu,
        }
    }
}

/// Samples that are not worth opening a graphics device for: a second of an ordinary processor.
const LITTLE_WORK: u64 = 1 << 24;

/// What to do where the graphics device is asked for and does not trace.
pub const INSTEAD: &str = "the graphics device does not trace this; --device cpu does";

impl DeviceChoice {
    /// Opens the graphics device that is to trace so many samples without a window; `None` for the processor.
    ///
    /// # Errors
    /// If the user wants one and there is none.
    pub fn open(self, samples: u64) -> anyhow::Result<Option<Gpu>> {
        let there_is_hardware = || Gpu::adapters().iter().any(|adapter| adapter.chosen && !adapter.software);
        match self {
            DeviceChoice::Gpu => Gpu::headless().context(INSTEAD).map(Some),
            // what does not open is not faster
            _ if self.is_for_a_device(samples, there_is_hardware) => Ok(Gpu::headless().ok()),
            _ => Ok(None),
        }
    }

    /// Where the processor plays the device it is faster as itself, and also where there is little to do.
    fn is_for_a_device(self, samples: u64, there_is_hardware: impl FnOnce() -> bool) -> bool {
        match self {
            DeviceChoice::Cpu => false,
            DeviceChoice::Gpu => true,
            DeviceChoice::Auto => samples >= LITTLE_WORK && there_is_hardware(),
        }
    }
}

impl Device {
    /// The name of the device that asks for it.
    pub fn name(self) -> &'static str {
        match self {
            Device::Cpu => "cpu",
            Device::Gpu => "gpu",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn auto_takes_hardware_where_there_is_enough_to_do() {
        let of = |wish: DeviceChoice, samples, hardware| wish.is_for_a_device(samples, || hardware);
        assert!(of(DeviceChoice::Auto, LITTLE_WORK, true) && !of(DeviceChoice::Auto, LITTLE_WORK - 1, true));
        assert!(!of(DeviceChoice::Auto, u64::MAX, false));
        assert!(of(DeviceChoice::Gpu, 0, false) && !of(DeviceChoice::Cpu, u64::MAX, true));
    }

    #[test]
    fn auto_is_the_faster_machine_and_a_wish_is_a_wish() {
        assert_eq!(DeviceChoice::Auto.beside(true), Device::Cpu);
        assert_eq!(DeviceChoice::Auto.beside(false), Device::Gpu);
        assert_eq!([true, false].map(|software| DeviceChoice::Gpu.beside(software)), [Device::Gpu; 2]);
        assert_eq!([true, false].map(|software| DeviceChoice::Cpu.beside(software)), [Device::Cpu; 2]);
        assert_eq!(DeviceChoice::ALL.map(|device| DeviceChoice::named(device.name())), DeviceChoice::ALL.map(Some));
    }
}
