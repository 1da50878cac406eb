//! The machine that measures, as far as it tells.

use serde::{Deserialize, Serialize};
use std::time::{SystemTime, UNIX_EPOCH};

/// What measured seconds depend on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Host {
    /// Its name in the network; not shown on the page.
    pub name: String,
    /// Model of the processor.
    pub cpu: String,
    /// Threads that trace.
    pub threads: usize,
    /// Operating system and architecture.
    pub system: String,
    /// What draws the fakes, or why nothing does.
    pub adapter: String,
}

impl Host {
    /// This machine, whose GPU is described by `adapter`.
    pub fn this(adapter: String) -> Self {
        let line = |path: &str| std::fs::read_to_string(path).ok().map(|text| text.trim().to_owned());
        let name = line("/proc/sys/kernel/hostname").or_else(|| std::env::var("COMPUTERNAME").ok());
        Host {
            name: name.unwrap_or_default(),
            cpu: cpu_model(&line("/proc/cpuinfo").unwrap_or_default()),
            threads: rayon::current_num_threads(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            adapter,
        }
    }

    /// In one line.
    pub fn words(&self) -> String {
        format!("{} ({}, {} threads, {}, {})", self.name, self.cpu, self.threads, self.system, self.adapter)
    }
}

/// Linux' own words; elsewhere there are none without asking the system's libraries.
fn cpu_model(cpuinfo: &str) -> String {
    let value = |name: &str| {
        let line = cpuinfo.lines().find(|line| line.split(':').next().is_some_and(|n| n.trim() == name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    value("model name").or_else(|| value("Model")).unwrap_or_else(|| "a processor of unknown model".into())
}

/// Most memory that this process has held so far, in bytes, where the system tells (Linux' VmHWM).
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

/// A hash of this program's own file, so that two builds of one version are told apart: FNV-1a of 64 bits (Fowler, Noll
/// and Vo). Empty where the file cannot be read.
pub fn build_of_this_program() -> String {
    let bytes = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
    if bytes.is_empty() {
        return String::new();
    }
    let hash = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    format!("{:016x}", bytes.iter().fold(0xcbf2_9ce4_8422_2325, hash))
}

/// Today's date, UTC: "2026-03-01".
pub fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (year, month, day) = civil(seconds / 86_400);
    format!("{year}-{month:02}-{day:02}")
}

/// Days since 1970 to year, month, day: Howard Hinnant, "chrono-compatible low-level date algorithms",
/// `civil_from_days`.
fn civil(days: u64) -> (u64, u64, u64) {
    let z = days + 719_468;
    let (era, day_of_era) = (z / 146_097, z % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    // months from March on
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (year_of_era + era * 400 + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_days_have_their_dates() {
        assert_eq!(
            [0, 58, 59, 11_016, 20_512].map(civil),
            [(1970, 1, 1), (1970, 2, 28), (1970, 3, 1), (2000, 2, 29), (2026, 2, 28)]
        );
    }

    #[test]
    fn the_processor_is_read_from_linux_words() {
        let words = "processor\t: 0\nmodel\t\t: 85\nmodel name\t: Some CPU @ 2 GHz\nflags : a b\n";
        assert_eq!(cpu_model(words), "Some CPU @ 2 GHz");
        assert_eq!(cpu_model(""), "a processor of unknown model");
    }
}
