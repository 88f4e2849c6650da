//! What the system tells about this process.

/// CPU seconds that this process has used, all threads; 0 where the system does not tell.
pub fn cpu_seconds() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    0.0
}

/// Largest memory that this process has had resident [bytes]; none where the system does not tell.
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn the_process_uses_time_and_memory() {
        let start = cpu_seconds();
        let mut sum = 0u64;
        while cpu_seconds() - start < 0.02 {
            sum = std::hint::black_box(sum + 1);
        }
        assert!(peak_memory_bytes().expect("a number") > 100_000);
    }
}
