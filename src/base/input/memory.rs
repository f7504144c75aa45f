//! Checks whether something fits in memory, before it is computed.

use std::fs;

use super::InputError;

/// Checks that at least so many `bytes` of memory are free; `help` names a remedy.
pub(crate) fn check_memory(
    input: &str,
    value: String,
    bytes: f64,
    help: &str,
) -> Result<(), InputError> {
    let free = available().unwrap_or(A_LOT) as f64;
    if bytes <= free {
        return Ok(());
    }
    let [needed, free] = [bytes, free].map(size);
    let help = format!("it takes {needed} of memory at least, and {free} are free: {help}");
    Err(InputError::new(input, value, help))
}

/// Memory (bytes) that is free.
#[cfg(feature = "sweep")]
pub(crate) fn free_memory() -> f64 {
    available().unwrap_or(A_LOT) as f64
}

/// Memory (bytes) assumed to be free where the system does not report it.
const A_LOT: u64 = 1 << 40;

/// Memory (bytes) that is free for new data.
fn available() -> Option<u64> {
    let all = fs::read_to_string("/proc/meminfo").ok()?;
    let line = all.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()?.checked_mul(1024)
}

fn size(bytes: f64) -> String {
    const GIB: f64 = (1_u64 << 30) as f64;
    match bytes / GIB {
        large if large >= 1e5 => format!("{large:.1e} GiB"),
        usual => format!("{usual:.1} GiB"),
    }
}
