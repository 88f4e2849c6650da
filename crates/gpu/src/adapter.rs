//! The adapters of this machine, and the choice of one.

use crate::error::GpuError;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Storage buffers that a stage binds at most, and threads of a workgroup: every device that follows WebGPU
/// has as many.
const STORAGE_BUFFERS: u32 = 8;
const WORKGROUP_THREADS: u32 = 256;

/// Bytes of parameters that fit into immediates; no stage has more.
pub(crate) const MOST_IMMEDIATES: u32 = 96;

/// A device that could compute.
#[derive(Debug)]
pub struct Adapter {
    adapter: wgpu::Adapter,
    info: wgpu::AdapterInfo,
}

impl Adapter {
    /// All adapters of this machine, GPUs before software drivers. Their order is the order of their numbers.
    pub fn all() -> Vec<Self> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        // Numbers of workgroups come from the host or are 0. The check of indirect dispatches would be one
        // more dispatch each; without it no shader may ask for the number of workgroups, which DirectX 12
        // does not know then.
        descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
        let instance = wgpu::Instance::new(descriptor);
        let adapters = wait(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let mut all: Vec<Self> =
            adapters.into_iter().map(|adapter| Self { info: adapter.get_info(), adapter }).collect();
        all.sort_by_key(|adapter| match adapter.info.device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        });
        all
    }

    /// Adapter `number`, or the first that is usable.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`], [`GpuError::NoSuchDevice`].
    pub fn choose(number: Option<usize>) -> Result<Self, GpuError> {
        let all = Self::all();
        let found: Vec<String> = all.iter().map(Self::to_string).collect();
        let usable = |adapter: &Self| adapter.lacks().is_none();
        let no_adapter = |found| GpuError::NoAdapter { looked_for: looked_for().to_owned(), found };
        match number {
            None => all.into_iter().find(usable).ok_or_else(|| no_adapter(found)),
            Some(number) => {
                let chosen = all.into_iter().nth(number);
                let chosen = chosen.ok_or(GpuError::NoSuchDevice { number, found })?;
                if usable(&chosen) { Ok(chosen) } else { Err(no_adapter(vec![chosen.to_string()])) }
            }
        }
    }

    /// Name of the device.
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// Whether it is a program on the CPU: it shows that results are right, never how fast they are.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Size of the largest buffer that a stage can bind [bytes].
    pub fn largest_buffer(&self) -> u64 {
        let limits = self.adapter.limits();
        limits.max_buffer_size.min(limits.max_storage_buffer_binding_size)
    }

    /// What it lacks for this crate, if anything.
    pub fn lacks(&self) -> Option<String> {
        let limits = self.adapter.limits();
        let flags = self.adapter.get_downlevel_capabilities().flags;
        let missing = [
            (!flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS), "compute shaders"),
            (!flags.contains(wgpu::DownlevelFlags::INDIRECT_EXECUTION), "indirect dispatches"),
            (limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS, "8 storage buffers per stage"),
            (limits.max_compute_invocations_per_workgroup < WORKGROUP_THREADS, "workgroups of 256 threads"),
        ];
        let missing: Vec<&str> =
            missing.into_iter().filter(|(lacks, _)| *lacks).map(|(_, what)| what).collect();
        (!missing.is_empty()).then(|| missing.join(", "))
    }

    /// Opens the device with the largest buffers that it allows, and with time stamps and immediates where it
    /// has them.
    pub(crate) fn open(&self) -> Result<(wgpu::Device, wgpu::Queue), String> {
        let has = self.adapter.limits();
        let mut required_features =
            self.adapter.features() & (wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::IMMEDIATES);
        if has.max_immediate_size < MOST_IMMEDIATES {
            required_features.remove(wgpu::Features::IMMEDIATES);
        }
        let has_immediates = required_features.contains(wgpu::Features::IMMEDIATES);
        let required_limits = wgpu::Limits {
            max_immediate_size: if has_immediates { MOST_IMMEDIATES } else { 0 },
            max_buffer_size: has.max_buffer_size,
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("bowknot"),
            required_features,
            required_limits,
            ..wgpu::DeviceDescriptor::default()
        };
        wait(self.adapter.request_device(&descriptor)).map_err(|error| error.to_string())
    }
}

impl std::fmt::Display for Adapter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = match self.info.device_type {
            wgpu::DeviceType::DiscreteGpu => "GPU",
            wgpu::DeviceType::IntegratedGpu => "integrated GPU",
            wgpu::DeviceType::VirtualGpu => "virtual GPU",
            wgpu::DeviceType::Cpu => "software driver",
            wgpu::DeviceType::Other => "other device",
        };
        write!(f, "{} ({kind}, {}", self.info.name, self.info.backend)?;
        if !self.info.driver.is_empty() {
            write!(f, ", {} {}", self.info.driver, self.info.driver_info)?;
        }
        match self.lacks() {
            None => f.write_str(")"),
            Some(lacks) => write!(f, "; lacks {lacks})"),
        }
    }
}

/// The interfaces that this build asks.
fn looked_for() -> &'static str {
    if cfg!(windows) {
        "DirectX 12 and Vulkan"
    } else if cfg!(target_vendor = "apple") {
        "Metal"
    } else {
        "Vulkan"
    }
}

/// Waits for a future of wgpu. With the native backends these are ready at once, so the loop does not spin.
pub(crate) fn wait<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        match future.as_mut().poll(&mut context) {
            Poll::Ready(value) => return value,
            Poll::Pending => std::thread::yield_now(),
        }
    }
}
