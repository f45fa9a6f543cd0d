//! What a thread has cost: processor time where the system tells it, so that other programs are not counted.

/// Processor time of this thread [s] from an arbitrary beginning.
#[cfg(target_os = "linux")]
pub fn thread_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Time [s] from an arbitrary beginning; this system's threads tell no processor time.
#[cfg(not(target_os = "linux"))]
pub fn thread_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}
