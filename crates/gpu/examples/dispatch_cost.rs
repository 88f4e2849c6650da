//! What a dispatch, a wait and an atomic cost on the first device: the constants that decide how stages are
//! cut.
#![allow(clippy::print_stdout, reason = "an example")]

use std::time::Instant;

const SHADER: &str = "
@group(0) @binding(0) var<storage, read_write> data: array<u32>;
@group(0) @binding(1) var<storage, read_write> word: array<atomic<u32>>;
var<workgroup> shared_word: array<u32, 256>;
@compute @workgroup_size(256)
fn touch(@builtin(global_invocation_id) id: vec3u) { data[id.x] = data[id.x] * 3u + 1u; }
@compute @workgroup_size(256)
fn nothing(@builtin(global_invocation_id) id: vec3u) { if data[0] == 77u { data[id.x] = 1u; } }
@compute @workgroup_size(256)
fn same_word(@builtin(global_invocation_id) id: vec3u) { atomicMax(&word[0], data[id.x] & 1023u); }
@compute @workgroup_size(256)
fn reduced(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) t: u32) {
    shared_word[t] = data[id.x] & 1023u;
    for (var half = 128u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if t < half { shared_word[t] = max(shared_word[t], shared_word[t + half]); }
    }
    if t == 0u { atomicMax(&word[0], shared_word[0]); }
}
@compute @workgroup_size(256)
fn barriers(@builtin(local_invocation_index) t: u32) {
    shared_word[t] = data[t];
    for (var k = 0u; k < 1000u; k++) {
        workgroupBarrier();
        let other = shared_word[(t + k) & 255u];
        workgroupBarrier();
        shared_word[t] = other + 1u;
    }
    data[t] = shared_word[t];
}";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter = adapters.into_iter().min_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::Cpu => 2,
        _ => 1,
    });
    let adapter = adapter.ok_or("no adapter")?;
    println!("{}; {:?}", adapter.get_info().name, adapter.features());
    let descriptor = wgpu::DeviceDescriptor {
        required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
        ..wgpu::DeviceDescriptor::default()
    };
    let (device, queue) = block_on(adapter.request_device(&descriptor))?;
    let buffer = |words: u64, usage| {
        let usage = usage | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * words,
            usage,
            mapped_at_creation: false,
        })
    };
    let words = 16 << 20;
    let data = [(); 2].map(|()| buffer(words, wgpu::BufferUsages::STORAGE));
    let word = buffer(64, wgpu::BufferUsages::STORAGE);
    let map = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 256,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[entry(0), entry(1)],
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = |name| {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(name),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    };
    let groups = [0, 1].map(|k| {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: data[k].as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: word.as_entire_binding() },
            ],
        })
    });
    println!("| what | dispatches | workgroups | encode, us per dispatch | whole, us per dispatch |");
    println!("|---|--:|--:|--:|--:|");
    for (name, count, workgroups) in [
        ("touch", 1, 1),
        ("touch", 1000, 1),
        ("touch", 1000, 132),
        ("touch", 1000, 1024),
        ("touch", 100, 8192),
        ("touch", 100, 65_535),
        ("nothing", 1000, 1),
        ("nothing", 1000, 1024),
        ("nothing", 1000, 8192),
        ("same_word", 1000, 282),
        ("same_word", 1000, 832),
        ("reduced", 1000, 282),
        ("reduced", 1000, 832),
        ("barriers", 10, 1),
        ("barriers", 10, 132),
    ] {
        let pipeline = pipeline(name);
        let mut best = [f64::INFINITY; 2];
        for _ in 0..7 {
            let timer = Instant::now();
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            for _ in 0..count {
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &groups[0], &[]);
                pass.dispatch_workgroups(workgroups, 1, 1);
            }
            drop(pass);
            encoder.copy_buffer_to_buffer(&data[0], 0, &map, 0, 256);
            queue.submit([encoder.finish()]);
            let encoded = timer.elapsed().as_secs_f64();
            map.map_async(wgpu::MapMode::Read, .., |_| {});
            device.poll(wgpu::PollType::wait_indefinitely())?;
            let whole = timer.elapsed().as_secs_f64();
            map.unmap();
            best = [best[0].min(encoded), best[1].min(whole)];
        }
        let [encode, whole] = best.map(|seconds| 1e6 * seconds / f64::from(count));
        println!("| {name} | {count} | {workgroups} | {encode:.2} | {whole:.2} |");
    }
    Ok(())
}

/// Waits for a future of wgpu, which is ready at once.
fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = std::pin::pin!(future);
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    loop {
        if let std::task::Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}
