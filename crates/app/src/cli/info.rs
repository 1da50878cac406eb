//! `visavis info`: what this machine offers and what would be used.

use gpu::Gpu;

pub fn run() -> anyhow::Result<()> {
    super::print(&text())
}

/// A line for the processor, and one for each adapter.
pub fn text() -> String {
    let adapters = Gpu::adapters();
    let hardware = adapters.iter().any(|adapter| adapter.chosen && !adapter.software);
    let rays = if hardware { "the gpu below, and the cpu where there is little to do" } else { "the cpu" };
    let threads = rayon::current_num_threads();
    let mut text = format!("path tracing and whitted, --device auto: {rays}; cpu: {threads} threads\n");
    if adapters.is_empty() {
        text += "fake (raster) and window: no adapter found; install a GPU driver, or Mesa's software one \
                 (Debian, Ubuntu: apt install mesa-vulkan-drivers)\n";
    }
    for adapter in &adapters {
        let rays = if adapter.software { "" } else { ", and for rays" };
        let used = if adapter.chosen { format!("used for the fake{rays}") } else { "not used".to_owned() };
        text += &format!(
            "{} ({}, {}): {used}, {}; driver {}; pictures up to {} pixels a side\n",
            adapter.name, adapter.backend, adapter.device_type, adapter.why, adapter.driver, adapter.max_texture_size
        );
    }
    text
}
