//! An open device, which several engines share: its queue, its compiled stages, and what its driver reports.

use super::compiled::{Compiled, compile};
use crate::adapter::Adapter;
use crate::error::GpuError;
use crate::stages::Stage;
use std::collections::HashMap;
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex, PoisonError};

/// A device that is open.
#[derive(Debug)]
pub(super) struct Opened {
    pub name: String,
    pub is_software: bool,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Whether stages get their parameters as immediates, not in a buffer.
    pub has_immediates: bool,
    /// Compiled stages by name.
    stages: Mutex<HashMap<&'static str, Arc<Compiled>>>,
    /// Dispatches that were submitted since the host waited last.
    pub unread_dispatches: AtomicUsize,
    /// What the driver reported since the last look: it does so from other threads. That the device is lost
    /// stays.
    failure: Arc<Mutex<Option<Failure>>>,
}

#[derive(Clone, Debug)]
enum Failure {
    Driver(String),
    Lost(String),
}

impl Opened {
    pub fn new(adapter: &Adapter) -> Result<Self, GpuError> {
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
        let has_immediates = device.features().contains(wgpu::Features::IMMEDIATES);
        Ok(Self {
            name,
            is_software: adapter.is_software(),
            device,
            queue,
            has_immediates,
            stages: Mutex::default(),
            unread_dispatches: AtomicUsize::new(0),
            failure,
        })
    }

    /// A stage, compiled when it is first asked for.
    pub fn stage(&self, stage: &'static Stage) -> Arc<Compiled> {
        let mut stages = self.stages.lock().unwrap_or_else(PoisonError::into_inner);
        let compiled = stages
            .entry(stage.name)
            .or_insert_with(|| Arc::new(compile(&self.device, stage, self.has_immediates)));
        Arc::clone(compiled)
    }

    /// The first failure since the last look, as an error; a lost device at each look.
    pub fn check(&self) -> Result<(), GpuError> {
        let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match &*failure {
            Some(Failure::Lost(_)) => failure.clone(),
            _ => failure.take(),
        };
        match found {
            None => Ok(()),
            Some(Failure::Driver(message)) => Err(self.driver(message)),
            Some(Failure::Lost(reason)) => Err(GpuError::Lost { adapter: self.name.clone(), reason }),
        }
    }

    /// Gives the device up, for all engines on it.
    pub fn give_up(&self, reason: String) -> GpuError {
        let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        *failure = Some(Failure::Lost(reason.clone()));
        GpuError::Lost { adapter: self.name.clone(), reason }
    }

    pub fn driver(&self, message: String) -> GpuError {
        GpuError::Driver { adapter: self.name.clone(), message }
    }
}
