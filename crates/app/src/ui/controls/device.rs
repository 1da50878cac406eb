//! Where a pane's rays are traced. Absent where there is no adapter to choose.

use crate::engine::Side;
use crate::technique::{Device, DeviceChoice};
use crate::ui::widgets::choice;
use crate::ui::{Dump, Viewer};
use egui::{ComboBox, Ui};

pub fn show(viewer: &mut Viewer, side: Side, ui: &mut Ui, dump: &mut Dump) {
    let Some(best) = viewer.adapters.0.first() else { return };
    let pane = &mut viewer.settings.panes[side as usize];
    ui.label("Rays are traced by");
    let words = DeviceChoice::ALL.map(|d| (title(d).to_owned(), explain(d, best.software), pane.device == d));
    if let Some(index) = choice(&format!("{side:?} device"), words, ui, dump) {
        pane.device = DeviceChoice::ALL[index];
    }
    if pane.device.beside(best.software) == Device::Cpu {
        return;
    }
    let adapters = &viewer.adapters.0;
    let chosen = adapters.get(usize::from(pane.adapter)).unwrap_or(best);
    let name = format!("text {side:?} adapter");
    if adapters.len() == 1 {
        let text = format!("the GPU is {}", chosen.name);
        dump.note(&name, &text, ui.label(&text));
        return;
    }
    let combo = ComboBox::from_id_salt(&name).selected_text(&chosen.name).width(ui.available_width() - 8.0).truncate();
    let shown = combo.show_ui(ui, |ui| {
        for (index, adapter) in (0..).zip(adapters) {
            let entry = ui.selectable_label(pane.adapter == index, &adapter.name);
            if dump.note(&format!("{side:?} adapter {}", adapter.name), pane.adapter == index, entry).clicked() {
                pane.adapter = index;
            }
        }
    });
    let response = shown.response.on_hover_text("Which graphics device traces the rays").accessible_name("Adapter");
    dump.note(&name, &chosen.name, response);
}

fn title(device: DeviceChoice) -> &'static str {
    match device {
        DeviceChoice::Auto => "auto",
        DeviceChoice::Cpu => "the CPU",
        DeviceChoice::Gpu => "the GPU",
    }
}

fn explain(device: DeviceChoice, software: bool) -> &'static str {
    match device {
        DeviceChoice::Auto if software => "The CPU, which is faster here: it only plays the GPU",
        DeviceChoice::Auto => "The GPU, and the CPU where that fails",
        DeviceChoice::Cpu => "The processor's cores but one",
        DeviceChoice::Gpu => "The graphics device; the CPU takes over if it fails",
    }
}
