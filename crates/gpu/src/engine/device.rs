//! Runs recordings on a device.

use super::bindings::{Bindings, PARAMS_STRIDE, Place};
use super::opened::Opened;
use super::phases::{PhaseClock, PhaseSeconds};
use super::profile::Profile;
use super::traits::{Engine, SMALLEST_BUFFER};
use crate::adapter::{Adapter, wait};
use crate::error::GpuError;
use crate::recording::{BufferId, Command, Dispatch, Recording};
use bowknot_dynamics::DeviceWork;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Most dispatches of a command buffer. The device begins with the first ones while the host records the
/// others.
const MOST_DISPATCHES: usize = 32;

/// Seconds that the dispatches of a command buffer are meant to take at most: a driver takes a device for
/// lost that does not answer for two.
const MOST_SECONDS: f64 = 0.1;

/// Command buffers that the host waits for at once.
const AWAITED: usize = 64;

/// Time after which a device counts as lost that has not finished so many command buffers.
const TIME_LIMIT: Duration = Duration::from_secs(120);

/// Buffers and bind groups on a device. Several engines may share the device.
#[derive(Debug)]
pub struct DeviceEngine {
    opened: Arc<Opened>,
    buffers: Vec<Option<wgpu::Buffer>>,
    bindings: Bindings,
    /// The parameters of the dispatches of a recording, where they are not immediates.
    params: wgpu::Buffer,
    /// Where results are copied to, to be read.
    staging: wgpu::Buffer,
    /// Size of the largest buffer [bytes].
    largest_buffer: u64,
    /// Where the times of the stages go, if they are measured.
    profile: Option<Profile>,
    /// Measures phases; None if the device has no time stamps.
    clock: Option<PhaseClock>,
    work: DeviceWork,
    /// Most dispatches of the next command buffers.
    most_dispatches: usize,
    /// Command buffers since the host waited last, every so many of them.
    submitted: Vec<wgpu::SubmissionIndex>,
    /// Number of command buffers since then.
    command_buffers: usize,
    time_limit: Option<Duration>,
}

/// A dispatch, its number in the recording, and what runs it.
type Placed<'a> = (&'a Dispatch, u64, Place);

impl DeviceEngine {
    /// Opens an adapter.
    ///
    /// # Errors
    /// [`GpuError::Driver`] if it refuses.
    pub fn open(adapter: &Adapter) -> Result<Self, GpuError> {
        let opened = Arc::new(Opened::new(adapter)?);
        // A program on the CPU takes as long as it takes.
        let time_limit = (!opened.is_software).then_some(TIME_LIMIT);
        Ok(Self::of(opened, time_limit))
    }

    /// Another engine on the same device, with buffers of its own. Both have one queue, and stages are
    /// compiled once.
    pub fn beside(&self) -> Self {
        Self::of(Arc::clone(&self.opened), self.time_limit)
    }

    fn of(opened: Arc<Opened>, time_limit: Option<Duration>) -> Self {
        let limits = opened.device.limits();
        let params = if opened.has_immediates { 1 } else { 64 };
        Self {
            largest_buffer: limits.max_buffer_size.min(limits.max_storage_buffer_binding_size),
            buffers: Vec::new(),
            bindings: Bindings::default(),
            params: params_buffer(&opened.device, params),
            staging: staging_buffer(&opened.device, 4096),
            profile: None,
            clock: PhaseClock::new(&opened.device, &opened.queue),
            work: DeviceWork::default(),
            most_dispatches: MOST_DISPATCHES,
            submitted: Vec::new(),
            command_buffers: 0,
            time_limit,
            opened,
        }
    }

    /// Measures the stages from now on. Each dispatch then waits for the one before it, and the host for all
    /// of them.
    pub fn measure(&mut self, profile: Profile) {
        self.profile = Some(profile);
    }

    /// Sets how long the host waits for an answer of the device before it gives it up, with
    /// [`GpuError::Lost`]; None: for ever, as with a software driver.
    pub fn set_time_limit(&mut self, limit: Option<Duration>) {
        self.time_limit = limit;
    }

    /// Whether the device has time stamps.
    pub fn has_time_stamps(&self) -> bool {
        self.opened.device.features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Whether the device is a program on the CPU.
    pub fn is_software(&self) -> bool {
        self.opened.is_software
    }

    /// Name of the adapter.
    pub fn name(&self) -> &str {
        &self.opened.name
    }

    /// Refuses buffers of more than this many bytes, as a device of lower limits does: for tests of what
    /// happens then.
    pub fn limit_buffers(&mut self, bytes: u64) {
        self.largest_buffer = self.largest_buffer.min(bytes);
    }

    /// Ends the device as a reset or a removal would: for tests of what happens then.
    pub fn lose(&self) {
        self.opened.device.destroy();
    }

    fn buffer_of(&self, id: BufferId) -> &wgpu::Buffer {
        find(&self.buffers, id)
    }

    /// Uploads the parameters of all dispatches.
    fn upload_params(&mut self, dispatches: usize, recording: &Recording) {
        let needed = dispatches as u64 * PARAMS_STRIDE;
        if self.params.size() < needed {
            self.params = params_buffer(&self.opened.device, dispatches.next_power_of_two());
            self.bindings.forget_all();
        }
        let mut bytes = vec![0u8; needed as usize];
        for (dispatch, place) in dispatches_of(recording).zip(bytes.chunks_exact_mut(PARAMS_STRIDE as usize))
        {
            let params: &[u8] = bytemuck::cast_slice(&dispatch.params);
            place[..params.len()].copy_from_slice(params);
        }
        self.opened.queue.write_buffer(&self.params, 0, &bytes);
    }

    /// Compiles the stages of a recording and binds its buffers.
    fn place(&mut self, recording: &Recording) -> Vec<Place> {
        let Self { opened, buffers, bindings, params, .. } = self;
        let place = |dispatch| bindings.place(opened, dispatch, params, |id| find(buffers, id));
        dispatches_of(recording).map(place).collect()
    }

    /// Records the dispatches, with one pass per phase if phases are measured.
    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        dispatches: &[Placed<'_>],
        clock: &mut Option<PhaseClock>,
    ) {
        let is_timed = clock.is_some();
        for part in dispatches.chunk_by(|(a, ..), (b, ..)| !is_timed || a.phase == b.phase) {
            let timestamp_writes = clock.as_mut().and_then(|clock| clock.stamps(part[0].0.phase));
            let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
            let mut pass = encoder.begin_compute_pass(&descriptor);
            self.encode_pass(&mut pass, part);
        }
    }

    /// Runs the dispatches, each in a pass of its own between two time stamps, and waits for them.
    fn run_measured(&self, dispatches: &[Placed<'_>], profile: &Profile) -> Result<(), GpuError> {
        for part in dispatches.chunks(wgpu::QUERY_SET_MAX_QUERIES as usize / 2) {
            let times =
                if self.has_time_stamps() { self.time_stamps(part)? } else { vec![0; 2 * part.len()] };
            if !self.has_time_stamps() {
                let mut encoder = self.encoder();
                self.encode(&mut encoder, part, &mut None);
                self.opened.queue.submit([encoder.finish()]);
            }
            let unit = 1e-9 * f64::from(self.opened.queue.get_timestamp_period());
            for ((dispatch, ..), times) in part.iter().zip(times.chunks_exact(2)) {
                let bytes = dispatch.buffers.iter().map(|&buffer| self.buffer_of(buffer).size()).sum();
                let seconds = times[1].saturating_sub(times[0]) as f64 * unit;
                profile.add(dispatch.stage.name, seconds, bytes);
            }
        }
        Ok(())
    }

    /// Time stamps before and after each dispatch.
    fn time_stamps(&self, dispatches: &[Placed<'_>]) -> Result<Vec<u64>, GpuError> {
        let count = 2 * dispatches.len() as u32;
        let queries = self.opened.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("times"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let buffer = |label, usage| {
            let size = 8 * u64::from(count);
            self.opened.device.create_buffer(&wgpu::BufferDescriptor {
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
        self.opened.queue.submit([encoder.finish()]);
        let words = self.map(&staging, staging.size())?;
        Ok(words.chunks_exact(2).map(|pair| u64::from(pair[1]) << 32 | u64::from(pair[0])).collect())
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.opened.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    fn encode_pass(&self, pass: &mut wgpu::ComputePass<'_>, dispatches: &[Placed<'_>]) {
        for (dispatch, number, place) in dispatches {
            let (pipeline, group) = self.bindings.at(*place);
            pass.set_pipeline(pipeline);
            if self.opened.has_immediates {
                pass.set_bind_group(0, group, &[]);
                pass.set_immediates(0, bytemuck::cast_slice(&dispatch.params));
            } else {
                pass.set_bind_group(0, group, &[(number * PARAMS_STRIDE) as u32]);
            }
            match dispatch.arguments {
                None => pass.dispatch_workgroups(dispatch.workgroups() as u32, 1, 1),
                Some((arguments, place)) => {
                    pass.dispatch_workgroups_indirect(self.buffer_of(arguments), 12 * place as u64);
                }
            }
        }
    }

    /// Copies the buffers that are read to where the host reads.
    fn encode_reads(&self, encoder: &mut wgpu::CommandEncoder, read: &[(BufferId, usize)]) {
        let mut offset = 0;
        for &(buffer, words) in read {
            let bytes = 4 * words as u64;
            encoder.copy_buffer_to_buffer(self.buffer_of(buffer), 0, &self.staging, offset, bytes);
            offset += bytes;
        }
    }

    /// Waits for what was submitted and takes the first bytes of a buffer.
    fn map(&self, staging: &wgpu::Buffer, bytes: u64) -> Result<Vec<u32>, GpuError> {
        staging.map_async(wgpu::MapMode::Read, ..bytes, |_| {});
        self.submitted.iter().try_for_each(|index| self.wait_for(Some(index.clone())))?;
        self.wait_for(None)?;
        let view =
            staging.get_mapped_range(..bytes).map_err(|error| self.opened.driver(error.to_string()))?;
        let words = bytemuck::pod_collect_to_vec(&view[..]);
        drop(view);
        staging.unmap();
        Ok(words)
    }

    /// Waits for a submission, or for all of them.
    fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let wait = wgpu::PollType::Wait { submission_index, timeout: self.time_limit };
        let polled = self.opened.device.poll(wait);
        self.opened.check()?;
        match polled {
            Ok(_) => Ok(()),
            Err(wgpu::PollError::Timeout) => {
                let seconds = self.time_limit.unwrap_or_default().as_secs_f64();
                Err(self.opened.give_up(format!("no answer within {seconds} s")))
            }
            Err(error) => Err(self.opened.driver(error.to_string())),
        }
    }
}

impl Engine for DeviceEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let size = 4 * words.max(SMALLEST_BUFFER) as u64;
        if size > self.largest_buffer {
            let (adapter, most) = (self.opened.name.clone(), self.largest_buffer);
            return Err(GpuError::TooLarge { adapter, what: label, bytes: size, most });
        }
        let scope = self.opened.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::INDIRECT
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC;
        let descriptor =
            wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = self.opened.device.create_buffer(&descriptor);
        if wait(scope.pop()).is_some() {
            return Err(GpuError::OutOfMemory {
                adapter: self.opened.name.clone(),
                what: label,
                bytes: size,
            });
        }
        self.work.buffers += 1;
        self.buffers.push(Some(buffer));
        Ok(BufferId(self.buffers.len() as u32 - 1))
    }

    fn free(&mut self, buffer: BufferId) {
        self.buffers[buffer.0 as usize] = None;
        self.bindings.forget(buffer);
    }

    fn clear(&mut self) {
        self.buffers.clear();
        self.bindings.forget_all();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.buffer_of(buffer).size() as usize / 4
    }

    fn most_words(&self) -> usize {
        usize::try_from(self.largest_buffer / 4).unwrap_or(usize::MAX)
    }

    fn work(&self) -> DeviceWork {
        self.work
    }

    fn take_phase_seconds(&mut self) -> Option<PhaseSeconds> {
        self.clock.as_mut().map(PhaseClock::take)
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        self.opened.check()?;
        let timer = Instant::now();
        let dispatches = recording.dispatch_count();
        self.work.count(dispatches, read.len());
        if dispatches > 0 && !self.opened.has_immediates {
            self.upload_params(dispatches, recording);
        }
        let places = self.place(recording);
        let mut clock = self.clock.take();
        clock.iter_mut().for_each(PhaseClock::begin);
        let submitted = self.submit(recording, &places, read, &mut clock);
        self.work.encode_s += timer.elapsed().as_secs_f64();
        let result = submitted.and_then(|bytes| self.read(bytes, read, &mut clock));
        self.clock = clock;
        result
    }
}

impl DeviceEngine {
    /// Submits a recording whose stages are compiled, with copies of what is read. Returns the number of
    /// bytes to read.
    fn submit(
        &mut self,
        recording: &Recording,
        places: &[Place],
        read: &[(BufferId, usize)],
        clock: &mut Option<PhaseClock>,
    ) -> Result<u64, GpuError> {
        // Writes take place before the next submit: what was recorded before them is submitted first.
        let mut waiting: Vec<Placed<'_>> = Vec::new();
        let mut places = (0..).zip(places);
        for command in &recording.commands {
            match command {
                Command::Dispatch(dispatch) => {
                    let Some((number, place)) = places.next() else { break };
                    waiting.push((dispatch, number, *place));
                    if waiting.len() >= self.most_dispatches {
                        self.submit_dispatches(&mut waiting, clock)?;
                    }
                }
                Command::Write { buffer, words } => {
                    self.submit_dispatches(&mut waiting, clock)?;
                    let bytes = bytemuck::cast_slice(words);
                    self.opened.queue.write_buffer(self.buffer_of(*buffer), 0, bytes);
                }
            }
        }
        self.submit_dispatches(&mut waiting, clock)?;
        let words: u64 = read.iter().map(|(_, words)| *words as u64).sum();
        if words == 0 {
            // Writes alone are on their way as well.
            self.opened.queue.submit([]);
            return self.opened.check().map(|()| 0);
        }
        let bytes = 4 * words + clock.as_ref().map_or(0, PhaseClock::bytes);
        if self.staging.size() < bytes {
            self.work.buffers += 1;
            let most = self.opened.device.limits().max_buffer_size;
            self.staging =
                staging_buffer(&self.opened.device, bytes.next_power_of_two().min(most).max(bytes));
        }
        let mut encoder = self.encoder();
        self.encode_reads(&mut encoder, read);
        clock.iter().for_each(|clock| clock.encode_read(&mut encoder, &self.staging, 4 * words));
        self.opened.queue.submit([encoder.finish()]);
        Ok(bytes)
    }

    /// Submits dispatches, if there are any.
    fn submit_dispatches(
        &mut self,
        dispatches: &mut Vec<Placed<'_>>,
        clock: &mut Option<PhaseClock>,
    ) -> Result<(), GpuError> {
        if dispatches.is_empty() {
            return Ok(());
        }
        match &self.profile {
            Some(profile) => self.run_measured(dispatches, profile)?,
            None => {
                let mut encoder = self.encoder();
                self.encode(&mut encoder, dispatches, clock);
                let index = self.opened.queue.submit([encoder.finish()]);
                self.command_buffers += 1;
                if self.command_buffers.is_multiple_of(AWAITED) {
                    self.submitted.push(index);
                }
            }
        }
        self.opened.unread_dispatches.fetch_add(dispatches.len(), Ordering::Relaxed);
        dispatches.clear();
        Ok(())
    }

    /// Waits for a submission and takes what it copied, so many bytes.
    fn read(
        &mut self,
        bytes: u64,
        read: &[(BufferId, usize)],
        clock: &mut Option<PhaseClock>,
    ) -> Result<Vec<Vec<u32>>, GpuError> {
        if bytes == 0 {
            return Ok(read.iter().map(|_| Vec::new()).collect());
        }
        let timer = Instant::now();
        let all = self.map(&self.staging, bytes);
        self.submitted.clear();
        self.command_buffers = 0;
        if all.is_err() {
            // It may still be mapped.
            self.staging = staging_buffer(&self.opened.device, self.staging.size());
        }
        let all = all?;
        let seconds = timer.elapsed().as_secs_f64();
        self.work.wait_s += seconds;
        let dispatches = self.opened.unread_dispatches.swap(0, Ordering::Relaxed);
        self.most_dispatches =
            dispatches_within(MOST_SECONDS, seconds, dispatches).unwrap_or(self.most_dispatches);
        let words: usize = read.iter().map(|(_, words)| words).sum();
        clock.iter_mut().for_each(|clock| clock.add(&all[words..]));
        let mut all = all.into_iter();
        Ok(read.iter().map(|&(_, words)| all.by_ref().take(words).collect()).collect())
    }
}

/// Most dispatches of a command buffer, where so many took `seconds` and a command buffer may take `most`
/// [s]; None where there were none.
fn dispatches_within(most: f64, seconds: f64, dispatches: usize) -> Option<usize> {
    let fit = most * dispatches as f64 / seconds;
    (dispatches > 0).then(|| (fit as usize).clamp(1, MOST_DISPATCHES))
}

fn dispatches_of(recording: &Recording) -> impl Iterator<Item = &Dispatch> {
    recording.commands.iter().filter_map(|command| match command {
        Command::Dispatch(dispatch) => Some(dispatch),
        Command::Write { .. } => None,
    })
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

fn staging_buffer(device: &wgpu::Device, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

#[cfg(test)]
mod tests {
    use super::{MOST_DISPATCHES, dispatches_within};

    #[test]
    fn command_buffers_of_slow_dispatches_have_few() {
        assert_eq!(dispatches_within(0.1, 1.0, 100), Some(10));
        assert_eq!(dispatches_within(0.1, 5.0, 2), Some(1));
        assert_eq!(dispatches_within(0.1, 1e-3, 500), Some(MOST_DISPATCHES));
        // What is read without dispatches tells nothing.
        assert_eq!(dispatches_within(0.1, 1.0, 0), None);
    }
}
