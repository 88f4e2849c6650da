//! What can keep a picture from being made.

use bowknot_geometry::VertexOutOfRange;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No graphics driver answers.
    #[error(
        "no graphics driver was found{}. {}",
        .reason.as_deref().map(|r| format!(" ({r})")).unwrap_or_default(),
        driver_remedy()
    )]
    NoDriver {
        /// What the system says, in one line.
        reason: Option<String>,
    },
    /// The driver refused a device or lost it.
    #[error("the graphics driver of {adapter} failed: {message}")]
    Device {
        /// The device's name.
        adapter: String,
        /// What the driver says.
        message: String,
    },
    /// The picture has no pixels or more than the device can draw.
    #[error("a picture of {width} x {height} pixels: each side must lie from 16 to {most}")]
    Size {
        /// Width [pixels].
        width: u32,
        /// Height [pixels].
        height: u32,
        /// Largest side that the device can draw [pixels].
        most: u32,
    },
    /// A frame does not fit its model.
    #[error("{what} has {given} entries for {expected} vertices")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        given: usize,
        /// Number of vertices.
        expected: usize,
    },
    /// An element names a vertex that does not exist.
    #[error(transparent)]
    VertexOutOfRange(#[from] VertexOutOfRange),
    /// A camera that looks nowhere.
    #[error("the camera is at its target {0:?}: move one of them")]
    BlindCamera([f64; 3]),
    /// A picture cannot be encoded or written.
    #[error("cannot encode the picture: {0}")]
    Encode(#[from] std::io::Error),
}

/// Which package brings a driver, by system. Mesa's software driver, lavapipe, serves everywhere on Linux.
fn driver_remedy() -> &'static str {
    if cfg!(target_os = "linux") {
        "Install a Vulkan driver; without a GPU a software driver serves: Debian, Ubuntu: apt install \
         mesa-vulkan-drivers; Fedora: dnf install mesa-vulkan-drivers; Arch: pacman -S vulkan-swrast; Alpine: apk add \
         mesa-vulkan-swrast vulkan-loader; openSUSE: zypper install libvulkan_lvp"
    } else if cfg!(windows) {
        "Install the graphics card's driver; Windows brings a software driver (WARP) of its own from version 10 on"
    } else if cfg!(target_vendor = "apple") {
        "Metal comes with macOS 10.13 or later; a virtual machine may lack it"
    } else {
        "Install a Vulkan driver, such as Mesa's lavapipe"
    }
}
