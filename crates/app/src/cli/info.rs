//! `visavis info`: what this machine offers and what would be used.

use gpu::Gpu;

pub fn run() -> anyhow::Result<()> {
    let adapters = Gpu::adapters();
    let mut text = format!("truth (path): cpu, {} threads\n", rayon::current_num_threads());
    if adapters.is_empty() {
        text += "fake (raster) and window: no adapter found; install a GPU driver, or Mesa's software one \
                 (Debian, Ubuntu: apt install mesa-vulkan-drivers)\n";
    }
    for adapter in &adapters {
        let used = if adapter.chosen { "used for the fake and the window" } else { "not used" };
        text += &format!(
            "{} ({}, {}): {used}, {}; driver {}; pictures up to {} pixels a side\n",
            adapter.name, adapter.backend, adapter.device_type, adapter.why, adapter.driver, adapter.max_texture_size
        );
    }
    super::print(&text)
}
