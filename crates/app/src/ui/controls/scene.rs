//! What is changed in the scene, for both panes at once.

use crate::ui::UiContext;
use crate::ui::widgets::Stepped;
use egui::Ui;

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let changes = &mut cx.model.document.changes;
    if let Some(own) = cx.model.document.scene.refraction_ratio() {
        let ratio = changes.refraction_ratio.unwrap_or(own);
        let slider = Stepped {
            name: "refraction ratio",
            label: &format!("Refraction ratio (n = {:.2})", 1.0 / ratio),
            hover: "Index of refraction outside over inside; 1 is no glass at all",
            range: 0.4..=1.0,
            step: 0.01,
            suffix: "",
        };
        slider.show_over(own, &mut changes.refraction_ratio, ui, cx.dump);
    }
    if let Some(sun) = cx.model.document.scene.sun {
        let slider = Stepped {
            name: "sun radius",
            label: "Sun radius (the fake's is 0)",
            hover: "0: hard shadows and no caustic. Larger: softer shadows",
            range: 0.0..=5.0,
            step: 0.1,
            suffix: "°",
        };
        slider.show_over(sun.angular_radius, &mut changes.sun_radius, ui, cx.dump);
    }
}
