//! Where a pane's rays are traced. Absent where there is no adapter to choose.

use crate::model::PaneId;
use crate::ui::UiContext;
use crate::ui::widgets::{Explained, choice};
use egui::{ComboBox, Ui};
use technique::settings::capitalised;
use technique::{Device, DeviceChoice, Technique};

pub fn show(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let Some(best) = cx.model.adapters.0.first() else { return };
    let settings = &mut cx.model.session.panes[pane];
    if let Technique::Traced(traced) = settings.in_use()
        && let Some(why) = traced.needs_the_processor()
    {
        cx.dump.note(&format!("text {pane} device"), why, ui.label(capitalised(why)));
        return;
    }
    let label = "Rays are traced by";
    ui.label(label);
    let words = DeviceChoice::ALL.map(|d| (title(d).to_owned(), explain(d, best.software), settings.device == d));
    if let Some(index) = choice((&format!("{pane} device"), label), words, ui, cx.dump) {
        settings.device = DeviceChoice::ALL[index];
    }
    if settings.device.beside(best.software) == Device::Cpu {
        return;
    }
    let adapters = &cx.model.adapters.0;
    let chosen = adapters.get(usize::from(settings.adapter)).unwrap_or(best);
    let name = format!("text {pane} adapter");
    if adapters.len() == 1 {
        let text = format!("The GPU is {}", chosen.name);
        cx.dump.note(&name, &text, ui.label(&text));
        return;
    }
    let combo = ComboBox::from_id_salt(&name).selected_text(&chosen.name).width(ui.available_width() - 8.0).truncate();
    let shown = combo.show_ui(ui, |ui| {
        for (index, adapter) in (0..).zip(adapters) {
            let entry = ui.selectable_label(settings.adapter == index, &adapter.name);
            if cx.dump.note(&format!("{pane} adapter {}", adapter.name), settings.adapter == index, entry).clicked() {
                settings.adapter = index;
            }
        }
    });
    let response = shown.response.explained("Which graphics device traces the rays").accessible_name("Adapter");
    cx.dump.note(&name, &chosen.name, response);
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
        DeviceChoice::Cpu => "All cores of the processor; the window goes first",
        DeviceChoice::Gpu => "The graphics device; the CPU takes over if it fails",
    }
}
