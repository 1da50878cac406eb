//! Where a pane's rays are traced. Absent where there is no adapter to choose.

use super::widgets::choice;
use crate::technique::{Device, Machine};
use crate::ui::{Dump, Viewer};
use crate::workers::Side;
use egui::Ui;

pub fn show(viewer: &mut Viewer, side: Side, ui: &mut Ui, dump: &mut Dump) {
    let Some(adapter) = &viewer.adapter else { return };
    let device = &mut viewer.settings.panes[side as usize].device;
    ui.label("Rays are traced by");
    let words = Device::ALL.map(|d| (title(d).to_owned(), explain(d, adapter.software), *device == d));
    if let Some(index) = choice(&format!("{side:?} device"), words, ui, dump) {
        *device = Device::ALL[index];
    }
    if device.beside(adapter.software) == Machine::Gpu {
        let name = format!("the GPU is {}", adapter.name);
        dump.note(&format!("text {side:?} adapter"), &name, ui.label(&name));
    }
}

fn title(device: Device) -> &'static str {
    match device {
        Device::Auto => "auto",
        Device::Cpu => "the CPU",
        Device::Gpu => "the GPU",
    }
}

fn explain(device: Device, software: bool) -> &'static str {
    match device {
        Device::Auto if software => "The CPU, which is faster here: it only plays the GPU",
        Device::Auto => "The GPU, and the CPU where that fails",
        Device::Cpu => "The processor's cores but one",
        Device::Gpu => "The graphics device; the CPU takes over if it fails",
    }
}
