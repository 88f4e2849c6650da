//! Runs recordings on a device.

use super::phases::{PhaseClock, PhaseSeconds};
use super::pipelines::{PARAMS_STRIDE, Pipelines};
use super::profile::Profile;
use super::traits::{Engine, SMALLEST_BUFFER};
use crate::adapter::{Adapter, wait};
use crate::error::GpuError;
use crate::recording::{BufferId, Command, Dispatch, Recording};
use bowknot_dynamics::DeviceWork;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// A device with its buffers and pipelines.
#[derive(Debug)]
pub struct DeviceEngine {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    buffers: Vec<Option<wgpu::Buffer>>,
    pipelines: Pipelines,
    /// The parameters of the dispatches of a recording.
    params: wgpu::Buffer,
    /// Size of the largest buffer [bytes].
    largest_buffer: u64,
    /// Where the times of the stages go, if they are measured.
    profile: Option<Profile>,
    /// Measures phases; None if the device has no time stamps.
    clock: Option<PhaseClock>,
    /// What the driver reported since the last look: it does so from other threads.
    failure: Arc<Mutex<Option<Failure>>>,
    work: DeviceWork,
}

#[derive(Debug)]
enum Failure {
    Driver(String),
    Lost(String),
}

impl DeviceEngine {
    /// Opens an adapter.
    ///
    /// # Errors
    /// [`GpuError::Driver`] if it refuses.
    pub fn open(adapter: &Adapter) -> Result<Self, GpuError> {
        let name = adapter.name().to_owned();
        let driver = |message: String| GpuError::Driver { adapter: name.clone(), message };
        let (device, queue) = adapter.open().map_err(driver)?;
        let failure: Arc<Mutex<Option<Failure>>> = Arc::default();
        let note = |failure: &Arc<Mutex<Option<Failure>>>, found: Failure| {
            let mut first = failure.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert(found);
        };
        let shared = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error| note(&shared, Failure::Driver(error.to_string()))));
        let shared = Arc::clone(&failure);
        device.set_device_lost_callback(move |reason, message| {
            let message = if message.is_empty() { format!("{reason:?}") } else { message };
            note(&shared, Failure::Lost(message));
        });
        let params = params_buffer(&device, 64);
        let limits = device.limits();
        let clock = PhaseClock::new(&device, &queue);
        Ok(Self {
            name,
            largest_buffer: limits.max_buffer_size.min(limits.max_storage_buffer_binding_size),
            device,
            queue,
            buffers: Vec::new(),
            pipelines: Pipelines::default(),
            params,
            profile: None,
            clock,
            failure,
            work: DeviceWork::default(),
        })
    }

    /// Measures the stages from now on. Each dispatch then waits for the one before it, and the host for all of them.
    pub fn measure(&mut self, profile: Profile) {
        self.profile = Some(profile);
    }

    /// Whether the device has time stamps.
    pub fn has_time_stamps(&self) -> bool {
        self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Name of the adapter.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Refuses buffers of more than this many bytes, as a device of lower limits does: for tests of what happens then.
    pub fn limit_buffers(&mut self, bytes: u64) {
        self.largest_buffer = self.largest_buffer.min(bytes);
    }

    /// Ends the device as a reset or a removal would: for tests of what happens then.
    pub fn lose(&self) {
        self.device.destroy();
    }

    /// The first failure since the last look, as an error.
    fn check(&self) -> Result<(), GpuError> {
        let found = self.failure.lock().unwrap_or_else(PoisonError::into_inner).take();
        match found {
            None => Ok(()),
            Some(Failure::Driver(message)) => Err(GpuError::Driver { adapter: self.name.clone(), message }),
            Some(Failure::Lost(reason)) => Err(GpuError::Lost { adapter: self.name.clone(), reason }),
        }
    }

    fn buffer_of(&self, id: BufferId) -> &wgpu::Buffer {
        find(&self.buffers, id)
    }

    /// Uploads the parameters of all dispatches.
    fn upload_params(&mut self, dispatches: usize, recording: &Recording) {
        let needed = dispatches as u64 * PARAMS_STRIDE;
        if self.params.size() < needed {
            self.params = params_buffer(&self.device, dispatches.next_power_of_two());
            self.pipelines.forget_all();
        }
        let mut bytes = vec![0u8; needed as usize];
        let mut place = 0;
        for command in &recording.commands {
            if let Command::Dispatch(dispatch) = command {
                let params: &[u8] = bytemuck::cast_slice(&dispatch.params);
                bytes[place..place + params.len()].copy_from_slice(params);
                place += PARAMS_STRIDE as usize;
            }
        }
        self.queue.write_buffer(&self.params, 0, &bytes);
    }

    fn prepare(&mut self, dispatch: &Dispatch) {
        let Self { device, buffers, pipelines, params, .. } = self;
        pipelines.prepare(device, dispatch, params, |id| find(buffers, id));
    }

    /// Records the dispatches, with one pass per phase if phases are measured.
    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        dispatches: &[(&Dispatch, u64)],
        clock: &mut Option<PhaseClock>,
    ) {
        let is_timed = clock.is_some();
        for part in dispatches.chunk_by(|(a, _), (b, _)| !is_timed || a.phase == b.phase) {
            let timestamp_writes = clock.as_mut().and_then(|clock| clock.stamps(part[0].0.phase));
            let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
            let mut pass = encoder.begin_compute_pass(&descriptor);
            self.encode_pass(&mut pass, part);
        }
    }

    /// Runs the dispatches, each in a pass of its own between two time stamps, and waits for them.
    fn run_measured(&self, dispatches: &[(&Dispatch, u64)], profile: &Profile) -> Result<(), GpuError> {
        for part in dispatches.chunks(wgpu::QUERY_SET_MAX_QUERIES as usize / 2) {
            let times =
                if self.has_time_stamps() { self.time_stamps(part)? } else { vec![0; 2 * part.len()] };
            if !self.has_time_stamps() {
                let mut encoder = self.encoder();
                self.encode(&mut encoder, part, &mut None);
                self.queue.submit([encoder.finish()]);
            }
            let unit = 1e-9 * f64::from(self.queue.get_timestamp_period());
            for ((dispatch, _), times) in part.iter().zip(times.chunks_exact(2)) {
                let bytes = dispatch.buffers.iter().map(|&buffer| self.buffer_of(buffer).size()).sum();
                let seconds = times[1].saturating_sub(times[0]) as f64 * unit;
                profile.add(dispatch.stage.name, seconds, bytes);
            }
        }
        Ok(())
    }

    /// Time stamps before and after each dispatch.
    fn time_stamps(&self, dispatches: &[(&Dispatch, u64)]) -> Result<Vec<u64>, GpuError> {
        let count = 2 * dispatches.len() as u32;
        let queries = self.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("times"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let buffer = |label, usage| {
            let size = 8 * u64::from(count);
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let resolved = buffer("times", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
        let staging = buffer("read times", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let mut encoder = self.encoder();
        for (first, dispatch) in (0..count).step_by(2).zip(dispatches) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                    query_set: &queries,
                    beginning_of_pass_write_index: Some(first),
                    end_of_pass_write_index: Some(first + 1),
                }),
            });
            self.encode_pass(&mut pass, std::slice::from_ref(dispatch));
        }
        encoder.resolve_query_set(&queries, 0..count, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &staging, 0, resolved.size());
        self.queue.submit([encoder.finish()]);
        let words = self.map(&staging)?;
        Ok(words.chunks_exact(2).map(|pair| u64::from(pair[1]) << 32 | u64::from(pair[0])).collect())
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    fn encode_pass(&self, pass: &mut wgpu::ComputePass<'_>, dispatches: &[(&Dispatch, u64)]) {
        for (dispatch, place) in dispatches {
            let (pipeline, group) = self.pipelines.of(dispatch);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[(place * PARAMS_STRIDE) as u32]);
            match dispatch.arguments {
                None => pass.dispatch_workgroups(dispatch.workgroups() as u32, 1, 1),
                Some((arguments, place)) => {
                    pass.dispatch_workgroups_indirect(self.buffer_of(arguments), 12 * place as u64);
                }
            }
        }
    }

    /// Copies the buffers that are read into `staging`.
    fn encode_reads(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        read: &[(BufferId, usize)],
        staging: &wgpu::Buffer,
    ) {
        let mut offset = 0;
        for &(buffer, words) in read {
            let bytes = 4 * words as u64;
            encoder.copy_buffer_to_buffer(self.buffer_of(buffer), 0, staging, offset, bytes);
            offset += bytes;
        }
    }

    fn map(&self, staging: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        let driver = |message: String| GpuError::Driver { adapter: self.name.clone(), message };
        polled.map_err(|error| driver(error.to_string()))?;
        let view = staging.get_mapped_range(..).map_err(|error| driver(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&view[..]))
    }
}

impl Engine for DeviceEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let size = 4 * words.max(SMALLEST_BUFFER) as u64;
        if size > self.largest_buffer {
            let (adapter, most) = (self.name.clone(), self.largest_buffer);
            return Err(GpuError::TooLarge { adapter, what: label, bytes: size, most });
        }
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::INDIRECT
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC;
        let descriptor =
            wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        if wait(scope.pop()).is_some() {
            return Err(GpuError::OutOfMemory { adapter: self.name.clone(), what: label, bytes: size });
        }
        self.work.buffers += 1;
        self.buffers.push(Some(buffer));
        Ok(BufferId(self.buffers.len() as u32 - 1))
    }

    fn free(&mut self, buffer: BufferId) {
        self.buffers[buffer.0 as usize] = None;
        self.pipelines.forget(buffer);
    }

    fn clear(&mut self) {
        self.buffers.clear();
        self.pipelines.forget_all();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.buffer_of(buffer).size() as usize / 4
    }

    fn most_words(&self) -> usize {
        usize::try_from(self.largest_buffer / 4).unwrap_or(usize::MAX)
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        self.check()?;
        let timer = Instant::now();
        let dispatches = recording.dispatch_count();
        self.work.count(dispatches, read.len());
        if dispatches > 0 {
            self.upload_params(dispatches, recording);
        }
        for command in &recording.commands {
            if let Command::Dispatch(dispatch) = command {
                self.prepare(dispatch);
            }
        }
        let mut clock = self.clock.take();
        clock.iter_mut().for_each(PhaseClock::begin);
        let staging = self.submit(recording, read, &mut clock);
        self.work.encode_s += timer.elapsed().as_secs_f64();
        let result = staging.and_then(|staging| self.read(staging, read, &mut clock));
        self.clock = clock;
        result
    }

    fn work(&self) -> DeviceWork {
        self.work
    }

    fn take_phase_seconds(&mut self) -> Option<PhaseSeconds> {
        self.clock.as_mut().map(PhaseClock::take)
    }
}

impl DeviceEngine {
    /// Submits a recording whose stages are compiled, with copies of what is read, if anything is, to a buffer.
    fn submit(
        &self,
        recording: &Recording,
        read: &[(BufferId, usize)],
        clock: &mut Option<PhaseClock>,
    ) -> Result<Option<wgpu::Buffer>, GpuError> {
        // Writes take place before the next submit: what was recorded before them is submitted first.
        let mut encoder = self.encoder();
        let mut waiting: Vec<(&Dispatch, u64)> = Vec::new();
        let mut place = 0;
        for command in &recording.commands {
            match command {
                Command::Dispatch(dispatch) => {
                    waiting.push((dispatch, place));
                    place += 1;
                }
                Command::Write { buffer, words } => {
                    if !waiting.is_empty() {
                        match &self.profile {
                            Some(profile) => self.run_measured(&waiting, profile)?,
                            None => self.encode(&mut encoder, &waiting, clock),
                        }
                        waiting.clear();
                        self.queue.submit([encoder.finish()]);
                        encoder = self.encoder();
                    }
                    self.queue.write_buffer(self.buffer_of(*buffer), 0, bytemuck::cast_slice(words));
                }
            }
        }
        match &self.profile {
            Some(profile) => self.run_measured(&waiting, profile)?,
            None if waiting.is_empty() => {}
            None => self.encode(&mut encoder, &waiting, clock),
        }
        let words: usize = read.iter().map(|(_, words)| words).sum();
        if words == 0 {
            self.queue.submit([encoder.finish()]);
            return self.check().map(|()| None);
        }
        let stamps = clock.as_ref().map_or(0, PhaseClock::bytes);
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read"),
            size: 4 * words as u64 + stamps,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.encode_reads(&mut encoder, read, &staging);
        clock.iter().for_each(|clock| clock.encode_read(&mut encoder, &staging, 4 * words as u64));
        self.queue.submit([encoder.finish()]);
        Ok(Some(staging))
    }

    /// Waits for a submission and takes what it copied to `staging`.
    fn read(
        &mut self,
        staging: Option<wgpu::Buffer>,
        read: &[(BufferId, usize)],
        clock: &mut Option<PhaseClock>,
    ) -> Result<Vec<Vec<u32>>, GpuError> {
        let Some(staging) = staging else { return Ok(read.iter().map(|_| Vec::new()).collect()) };
        let timer = Instant::now();
        self.work.buffers += 1;
        let all = self.map(&staging)?;
        self.work.wait_s += timer.elapsed().as_secs_f64();
        let words: usize = read.iter().map(|(_, words)| words).sum();
        clock.iter_mut().for_each(|clock| clock.add(&all[words..]));
        let mut all = all.into_iter();
        Ok(read.iter().map(|&(_, words)| all.by_ref().take(words).collect()).collect())
    }
}

fn find(buffers: &[Option<wgpu::Buffer>], id: BufferId) -> &wgpu::Buffer {
    buffers[id.0 as usize].as_ref().expect("a buffer is not used after it was freed")
}

fn params_buffer(device: &wgpu::Device, dispatches: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("params"),
        size: dispatches as u64 * PARAMS_STRIDE,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
