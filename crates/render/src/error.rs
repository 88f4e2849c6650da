//! Why a picture could not be made.

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
        /// The system's reason, in one line.
        reason: Option<String>,
    },
    /// The driver refused a device or lost it.
    #[error("the graphics driver of {adapter} failed: {message}")]
    Device {
        /// The device's name.
        adapter: String,
        /// The driver's message.
        message: String,
    },
    /// The picture has no pixels or more than the device can draw.
    #[error("a picture of {width} x {height} pixels: each side must lie from 16 to {largest}")]
    Size {
        /// Width [pixels].
        width: u32,
        /// Height [pixels].
        height: u32,
        /// Largest side that the device can draw [pixels].
        largest: u32,
    },
    /// The picture has more pixels than the device can hand over at once.
    #[error(
        "a picture of {width} x {height} pixels: {adapter} hands over {most} pixels at most; a smaller \
         one, such as {}x{}, fits",
        .fits[0], .fits[1]
    )]
    TooManyPixels {
        /// Width [pixels].
        width: u32,
        /// Height [pixels].
        height: u32,
        /// The device's name.
        adapter: String,
        /// Most pixels of a picture.
        most: u64,
        /// Sides of a picture of about the same shape that fits [pixels].
        fits: [u32; 2],
    },
    /// The device has no memory for the picture.
    #[error(
        "a picture of {width} x {height} pixels: {adapter} has no memory for it; draw a smaller one, or use a \
         device with more memory"
    )]
    OutOfMemory {
        /// Width [pixels].
        width: u32,
        /// Height [pixels].
        height: u32,
        /// The device's name.
        adapter: String,
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
    /// The eye of the camera is at its target, or a coordinate is not finite.
    #[error("the camera is at its target {0:?}: move one of them")]
    CameraAtTarget([f64; 3]),
    /// A picture cannot be encoded or written.
    #[error("cannot encode the picture: {0}")]
    Encode(#[from] std::io::Error),
}

/// How to install a driver on this system. Mesa's software driver, lavapipe, works on every Linux machine.
fn driver_remedy() -> &'static str {
    if cfg!(target_os = "linux") {
        "Install a Vulkan driver; without a GPU a software driver serves: Debian, Ubuntu: apt install \
         mesa-vulkan-drivers; Fedora: dnf install mesa-vulkan-drivers; Arch: pacman -S vulkan-swrast; \
         Alpine: apk add mesa-vulkan-swrast vulkan-loader; openSUSE: zypper install libvulkan_lvp"
    } else if cfg!(windows) {
        "Install the graphics card's driver; Windows brings a software driver (WARP) of its own from version \
         10 on"
    } else if cfg!(target_vendor = "apple") {
        "Metal comes with macOS 10.13 or later; a virtual machine may lack it"
    } else {
        "Install a Vulkan driver, such as Mesa's lavapipe"
    }
}
