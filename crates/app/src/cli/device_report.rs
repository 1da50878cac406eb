//! `visavis device-report`: what a graphics device is worth, on one page of text, from this program alone.

use super::args::ReportPart;
use super::{DeviceReportArgs, check as hard_cases, info};
use anyhow::Context;
use bench::device::{Extent, agreement, frames, peaks, rates, tell_rates};
use gpu::Gpu;
use std::process::Command;
use std::time::Instant;

/// Of a part that is measured, at least.
const SECONDS: f64 = 0.5;

/// Pictures of a drag, and on a device that is software.
const PICTURES: [usize; 2] = [60, 2];

/// Level of the statue: two million triangles are 9, and fewer for a device that is software.
const LEVELS: [u32; 2] = [9, 5];

pub fn run(args: &DeviceReportArgs) -> anyhow::Result<()> {
    if let Some(out) = &args.out {
        image_file::check_writable(out)?;
    }
    let begun = Instant::now();
    let gpu = Gpu::headless().context("there is no graphics device to report on")?;
    let software = usize::from(gpu.is_software());
    let (width, height) = args.size;
    let extent = Extent { size: args.size, seconds: SECONDS, pictures: PICTURES[software], level: LEVELS[software] };
    let mut page = format!("visavis {}: {}, {width} x {height}\n", env!("CARGO_PKG_VERSION"), gpu.describe());
    super::print(&page)?;
    for part in &args.parts {
        let late = begun.elapsed().as_secs() >= u64::from(args.seconds);
        let text = if late { Ok("left out: the time is up\n".into()) } else { told(*part, &gpu, &extent) };
        // what a part fails of is what the page is for
        let text = text.unwrap_or_else(|fault| format!("failed: {fault:#}\n"));
        let section = format!("\n== {} ({:.0} s)\n{text}", part.name(), begun.elapsed().as_secs_f64());
        super::print(&section)?;
        page += &section;
    }
    let Some(out) = &args.out else { return Ok(()) };
    Ok(image_file::write_or_keep(out, page.as_bytes())?)
}

fn told(part: ReportPart, gpu: &Gpu, extent: &Extent) -> anyhow::Result<String> {
    Ok(match part {
        ReportPart::Adapters => info::text(),
        ReportPart::Checks => hard_cases::in_short(gpu)?,
        ReportPart::Rates => {
            let peaks = peaks(gpu, extent.seconds)?;
            let [gflop, gigabytes] = [peaks.operations, peaks.bytes].map(|rate| 1e-9 * rate);
            let table = tell_rates(&rates(gpu, extent)?, Some(peaks));
            format!("at most {gflop:.0} Gflop/s of f32, {gigabytes:.1} GB/s read and written\n{table}")
        }
        ReportPart::Frames => frames(gpu, extent)?,
        ReportPart::Agreement => agreement(gpu)?,
        ReportPart::Loss => loss()?,
    })
}

/// Renders with this program while its device goes away.
fn loss() -> anyhow::Result<String> {
    let program = std::env::current_exe().context("this program can't find itself")?;
    let folder = std::env::temp_dir().join(format!("visavis-device-report-{}", std::process::id()));
    std::fs::create_dir_all(&folder)
        .with_context(|| format!("cannot make the folder {}", image_file::shown(&folder)))?;
    let picture = folder.join("lost.exr");
    let mut render = Command::new(program);
    render.args(["render", "cornell", "--device", "gpu", "--spp", "64", "--size", "256x256", "-o"]).arg(&picture);
    let output = render.env("VISAVIS_GPU_FAILS_AFTER", "3").output();
    let whole = picture.exists();
    // a folder that stays in the system's own for such is no failure of the device
    drop(std::fs::remove_dir_all(&folder));
    let output = output.context("this program can't be started again")?;
    let said = String::from_utf8_lossy(&output.stderr);
    // where the picture lay is nobody's business
    let said: String = said.lines().filter(|line| !line.contains("lost.exr")).map(|line| format!("{line}\n")).collect();
    let picture = if whole { "there" } else { "missing" };
    Ok(format!("lost after 3 dispatches: {}, the picture is {picture}\n{said}", output.status))
}
