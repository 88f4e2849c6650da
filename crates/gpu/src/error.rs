//! Why a device cannot be used.

use std::fmt;

/// An error of the device or of the driver.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter answers, or none has what is needed.
    #[error("{}", no_adapter(.looked_for, .found))]
    NoAdapter {
        /// The interfaces that were asked: Vulkan, Metal, ..
        looked_for: String,
        /// The adapters that were found, with what each lacks.
        found: Vec<String>,
    },
    /// There is no adapter of that number.
    #[error("there is no device {number}: {}", devices(.found))]
    NoSuchDevice {
        /// The number that was asked for.
        number: usize,
        /// The adapters that were found.
        found: Vec<String>,
    },
    /// The driver refused or failed.
    #[error("the driver of {adapter} failed: {message}")]
    Driver {
        /// The name of the adapter.
        adapter: String,
        /// The driver's message.
        message: String,
    },
    /// A buffer is larger than what the device binds.
    #[error(
        "{what} takes {bytes} bytes, but {adapter} binds {most} at most: use a smaller scene, another device or the CPU"
    )]
    TooLarge {
        /// The name of the adapter.
        adapter: String,
        /// The buffer.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// Size of the largest buffer of the device [bytes].
        most: u64,
    },
    /// The device has too little memory.
    #[error(
        "{adapter} has no memory for {what}, {bytes} bytes: use a smaller scene, a device with more memory or the CPU"
    )]
    OutOfMemory {
        /// The name of the adapter.
        adapter: String,
        /// The buffer.
        what: &'static str,
        /// Its size.
        bytes: u64,
    },
    /// The device was lost: it was reset or removed, or a watchdog ended its work.
    #[error(
        "{adapter} was lost ({reason}). The last accepted state is whole: go on from it, on this device or on the CPU"
    )]
    Lost {
        /// The name of the adapter.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
}

fn no_adapter(looked_for: &str, found: &[String]) -> String {
    let found = if found.is_empty() {
        String::new()
    } else {
        format!(" Found, but not usable: {}.", found.join("; "))
    };
    format!("no usable GPU was found through {looked_for}.{found} {}", remedy())
}

fn devices(found: &[String]) -> String {
    let list = found.iter().enumerate().map(|(number, name)| format!("{number} {name}"));
    if found.is_empty() { "none was found".to_owned() } else { list.collect::<Vec<_>>().join(", ") }
}

/// How to get a driver on this system.
fn remedy() -> impl fmt::Display {
    if cfg!(target_os = "linux") {
        "Install the Vulkan driver of the GPU. Mesa's software driver serves for tests: Debian, Ubuntu: apt install \
         mesa-vulkan-drivers; Fedora: dnf install mesa-vulkan-drivers; Arch: pacman -S vulkan-swrast"
    } else if cfg!(windows) {
        "Install the graphics card's driver"
    } else if cfg!(target_vendor = "apple") {
        "Metal comes with macOS 10.13 or later; a virtual machine may lack it"
    } else {
        "Install the Vulkan driver of the GPU, or Mesa's lavapipe for tests"
    }
}
