//! Which adapter is taken, and why.

use wgpu::{AdapterInfo, Backend, DeviceType};

/// What an adapter is worth; the greatest wins. Hardware goes before software, then the interface counts, then the kind
/// of device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    hardware: bool,
    interface: u8,
    device: u8,
}

impl Rank {
    /// The rank of an adapter.
    pub fn of(info: &AdapterInfo) -> Rank {
        let interface = match info.backend {
            Backend::Vulkan => 4,
            Backend::Metal => 3,
            Backend::Dx12 => 2,
            Backend::Gl => 1,
            Backend::Noop | Backend::BrowserWebGpu => 0,
        };
        let device = match info.device_type {
            DeviceType::DiscreteGpu => 3,
            DeviceType::IntegratedGpu => 2,
            DeviceType::VirtualGpu => 1,
            DeviceType::Other | DeviceType::Cpu => 0,
        };
        Rank { hardware: info.device_type != DeviceType::Cpu, interface, device }
    }
}

/// Index of the adapter to take: the greatest [`Rank`], the first of equals; `None` if there are none.
pub fn choose(infos: &[AdapterInfo]) -> Option<usize> {
    (0..infos.len()).rev().max_by_key(|&i| Rank::of(&infos[i]))
}

/// One adapter, for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterReport {
    /// The device's name.
    pub name: String,
    /// The interface it is reached through: Vulkan, GL, ...
    pub backend: String,
    /// Discrete, integrated, virtual, software or unknown.
    pub device_type: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Most pixels along a side of a texture.
    pub max_texture_size: u32,
    /// Whether the processor plays it.
    pub software: bool,
    /// How many before it have the same name and interface.
    pub twins_before: usize,
    /// Whether it is the one that is used.
    pub chosen: bool,
    /// Why it is used or not.
    pub why: String,
}

impl AdapterReport {
    /// Name and interface, by which [`crate::Gpu::headless_on`] finds it: as in "llvmpipe (LLVM 19.1, 256 bits),
    /// Vulkan"; of several that are alike each has its number.
    pub fn describe(&self) -> String {
        let name = format!("{}, {}", self.name, self.backend);
        if self.twins_before > 0 { format!("{name} ({})", self.twins_before + 1) } else { name }
    }
}

pub(crate) fn all(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

pub(crate) fn describe(info: &AdapterInfo) -> String {
    format!("{}, {}", info.name, interface_name(info.backend))
}

pub(crate) fn report(adapters: &[wgpu::Adapter]) -> Vec<AdapterReport> {
    let infos: Vec<_> = adapters.iter().map(wgpu::Adapter::get_info).collect();
    let chosen = choose(&infos);
    let entry = |(index, adapter): (usize, &wgpu::Adapter)| {
        let info = &infos[index];
        AdapterReport {
            name: info.name.clone(),
            backend: interface_name(info.backend).to_owned(),
            device_type: device_name(info.device_type).to_owned(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            max_texture_size: adapter.limits().max_texture_dimension_2d,
            software: info.device_type == DeviceType::Cpu,
            twins_before: infos[..index].iter().filter(|before| describe(before) == describe(info)).count(),
            chosen: chosen == Some(index),
            why: chosen.map(|best| reason(info, &infos[best], best == index)).unwrap_or_default(),
        }
    };
    adapters.iter().enumerate().map(entry).collect()
}

fn reason(this: &AdapterInfo, best: &AdapterInfo, chosen: bool) -> String {
    let (mine, first) = (Rank::of(this), Rank::of(best));
    if chosen {
        format!("the first in order: {} device through {}", device_name(this.device_type), interface_name(this.backend))
    } else if mine.hardware != first.hardware {
        "hardware goes before software".to_owned()
    } else if mine.interface != first.interface {
        format!("{} goes before {}", interface_name(best.backend), interface_name(this.backend))
    } else if mine.device != first.device {
        format!("a {} device goes before {}", device_name(best.device_type), device_name(this.device_type))
    } else {
        "another of the same kind answered first".to_owned()
    }
}

fn interface_name(backend: Backend) -> &'static str {
    match backend {
        Backend::Vulkan => "Vulkan",
        Backend::Metal => "Metal",
        Backend::Dx12 => "Direct3D 12",
        Backend::Gl => "OpenGL",
        Backend::BrowserWebGpu => "WebGPU",
        Backend::Noop => "nothing",
    }
}

fn device_name(device_type: DeviceType) -> &'static str {
    match device_type {
        DeviceType::DiscreteGpu => "discrete",
        DeviceType::IntegratedGpu => "integrated",
        DeviceType::VirtualGpu => "virtual",
        DeviceType::Cpu => "software",
        DeviceType::Other => "unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hardware_then_interface_then_kind_decide() {
        let of = |kinds: &[(DeviceType, Backend)]| {
            choose(&kinds.iter().map(|&(device, backend)| AdapterInfo::new(device, backend)).collect::<Vec<_>>())
        };
        use {Backend::*, DeviceType::*};
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[(Cpu, Vulkan), (IntegratedGpu, Gl)]), Some(1));
        assert_eq!(of(&[(DiscreteGpu, Gl), (IntegratedGpu, Vulkan)]), Some(1));
        assert_eq!(of(&[(VirtualGpu, Vulkan), (IntegratedGpu, Vulkan), (DiscreteGpu, Vulkan)]), Some(2));
        assert_eq!(of(&[(Cpu, Gl), (Cpu, Vulkan), (Cpu, Vulkan)]), Some(1));
        assert_eq!(of(&[(DiscreteGpu, Dx12), (DiscreteGpu, Metal)]), Some(1));
    }
}
