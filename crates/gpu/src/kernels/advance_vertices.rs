// Written from `shader/forward/advance_vertices.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "advance_vertices",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/most.wgsl"),
        include_str!("../../shader/forward/advance_vertices.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const OBSTACLE: u32 = 1u32;
pub const PRESCRIBED: u32 = 2u32;
pub const SELF_COLLIDES: u32 = 4u32;
pub const KNOWN: u32 = 8u32;
pub const ELEMENT_BITS: u32 = 29u32;
pub const ELEMENT_MASK: u32 = 536870911u32;
pub const VERTEX_VERTEX: u32 = 0u32;
pub const VERTEX_EDGE: u32 = 1u32;
pub const VERTEX_TRIANGLE: u32 = 2u32;
pub const EDGE_EDGE: u32 = 3u32;
pub const VERTEX_HALF_SPACE: u32 = 4u32;
pub const COLORS: u32 = 128u32;
pub const FIXED: u32 = 65535u32;
pub const WORDS: u32 = 6u32;
pub const LAG: u32 = 0u32;
pub const FREE_REMAINING: u32 = 1u32;
pub const FREE_MOVE: u32 = 2u32;
pub const LARGEST_MOVE: u32 = 3u32;
pub const UNHINDERED: u32 = 4u32;
pub const UNHINDERED_LAG: u32 = 5u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub progress: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::advance_vertices::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Vertex {
    pub edge: f32,
    pub margin: f32,
    pub body: u32,
    pub flags: u32,
    pub groups: u32,
    pub mask: u32,
    pub group: u32,
    pub delta: f32,
    pub half_space_delta: f32,
    pub thickness: f32,
    pub mass: f32,
    pub root_of_friction: f32,
}

impl Vertex {
    const ZERO: Self = Self {
        edge: 0.0f32,
        margin: 0.0f32,
        body: 0u32,
        flags: 0u32,
        groups: 0u32,
        mask: 0u32,
        group: 0u32,
        delta: 0.0f32,
        half_space_delta: 0.0f32,
        thickness: 0.0f32,
        mass: 0.0f32,
        root_of_friction: 0.0f32,
    };
}

impl Stored for Vertex {
    const WORDS: usize = 12;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            edge: <f32>::load(words, at + 0),
            margin: <f32>::load(words, at + 1),
            body: <u32>::load(words, at + 2),
            flags: <u32>::load(words, at + 3),
            groups: <u32>::load(words, at + 4),
            mask: <u32>::load(words, at + 5),
            group: <u32>::load(words, at + 6),
            delta: <f32>::load(words, at + 7),
            half_space_delta: <f32>::load(words, at + 8),
            thickness: <f32>::load(words, at + 9),
            mass: <f32>::load(words, at + 10),
            root_of_friction: <f32>::load(words, at + 11),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.edge.store(words, at + 0);
        self.margin.store(words, at + 1);
        self.body.store(words, at + 2);
        self.flags.store(words, at + 3);
        self.groups.store(words, at + 4);
        self.mask.store(words, at + 5);
        self.group.store(words, at + 6);
        self.delta.store(words, at + 7);
        self.half_space_delta.store(words, at + 8);
        self.thickness.store(words, at + 9);
        self.mass.store(words, at + 10);
        self.root_of_friction.store(words, at + 11);
    }
}

struct Memory<'a> {
    params: Params,
    targets: &'a [u32],
    vertices: &'a [u32],
    paths: &'a [u32],
    alphas: &'a [u32],
    group_alphas: &'a [u32],
    positions: &'a mut [u32],
    control: &'a mut [u32],
    late: &'a mut [u32],
    most: [u32; 1536],
    shared_overflow: u32,
}

pub fn find_most(m: &mut Memory<'_>, thread_a0: [u32; 256], own_a1: [[u32; 6]; 256]) {
    let mut k_v0: [u32; 256] = [0u32; 256];
    let mut reach_v1: u32 = 128u32;
    for t in 0..256 {
        'l0: loop {
            'c0: {
                let _e4 = k_v0[t];
                if (_e4 < 6u32) {
                } else {
                    break 'l0;
                }
                {
                    let _e9 = k_v0[t];
                    let _e13 = k_v0[t];
                    m.most[256u32.wrapping_mul(_e9).wrapping_add(thread_a0[t]) as usize] = (own_a1[t])[_e13 as usize];
                }
            }
            let _e15 = k_v0[t];
            k_v0[t] = _e15.wrapping_add(1u32);
        }
    }
    'l1: loop {
        'c1: {
            let _e20 = reach_v1;
            if (_e20 > 0u32) {
            } else {
                break 'l1;
            }
            {
                let _e23 = reach_v1;
                for t in 0..256 {
                    if (thread_a0[t] < _e23) {
                        let mut k_v2: u32;
                        k_v2 = 0u32;
                        'l2: loop {
                            'c2: {
                                let _e27 = k_v2;
                                if (_e27 < 6u32) {
                                } else {
                                    break 'l2;
                                }
                                {
                                    let _e31 = k_v2;
                                    let at_e33 = 256u32.wrapping_mul(_e31).wrapping_add(thread_a0[t]);
                                    let _e38 = m.most[at_e33 as usize];
                                    let _e40 = reach_v1;
                                    let _e43 = m.most[at_e33.wrapping_add(_e40) as usize];
                                    m.most[at_e33 as usize] = _e38.max(_e43);
                                }
                            }
                            let _e45 = k_v2;
                            k_v2 = _e45.wrapping_add(1u32);
                        }
                    }
                }
            }
        }
        let _e48 = reach_v1;
        reach_v1 = (_e48 / 2u32);
    }
}

pub fn note_progress(m: &mut Memory<'_>, v_a0: u32, left_a1: f32) {
    let _e5 = <u32>::load(m.late, 2 * (v_a0 as usize) + 1);
    let mut idle_steps_v0: u32;
    idle_steps_v0 = _e5.wrapping_add(1u32);
    let _e12 = <f32>::load(m.late, 2 * (v_a0 as usize));
    let _e15 = m.params.progress;
    if (left_a1 < (_e12 - _e15)) {
        Stored::store(left_a1, m.late, 2 * (v_a0 as usize));
        idle_steps_v0 = 0u32;
    }
    let _e25 = idle_steps_v0;
    Stored::store((if (left_a1 == 0.0f32) { 0u32 } else { _e25 }), m.late, 2 * (v_a0 as usize) + 1);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut largest_v0: [[u32; 6]; 256] = [[0u32; 6]; 256];
    let mut _e133: [[u32; 6]; 256] = [[0u32; 6]; 256];
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e8 = <u32>::load(m.control, 1);
            m.shared_overflow = _e8;
        }
    }
    let _e10 = { let t = 0; m.shared_overflow };
    if (_e10 != 0u32) {
        return;
    }
    for t in 0..256 {
        let mut v_v1: u32;
        v_v1 = ([256 * group + t as u32, 0, 0])[0];
        'l0: loop {
            'c0: {
                let _e17 = v_v1;
                let _e20 = m.params.vertices;
                if (_e17 < _e20) {
                } else {
                    break 'l0;
                }
                {
                    let _e23 = v_v1;
                    let vertex_e25 = <Vertex>::load(m.vertices, 12 * (_e23 as usize));
                    let _e27 = v_v1;
                    let _e29 = <u32>::load(m.alphas, 1 * (_e27 as usize));
                    let mut alpha_v2: f32;
                    alpha_v2 = f32::from_bits(_e29 as u32);
                    if ((vertex_e25).group != 4294967295u32) {
                        let _e38 = <u32>::load(m.group_alphas, 1 * ((vertex_e25).group as usize));
                        alpha_v2 = f32::from_bits(_e38 as u32);
                    }
                    let _e41 = v_v1;
                    let _e43 = <[i32; 4]>::load(m.positions, 4 * (_e41 as usize));
                    let position_e44 = swizzle(_e43, [0, 1, 2]);
                    let _e46 = v_v1;
                    let _e48 = <[i32; 4]>::load(m.targets, 4 * (_e46 as usize));
                    let displacement_e51 = zip(swizzle(_e48, [0, 1, 2]), position_e44, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                    let length_e53 = dot(displacement_e51, displacement_e51).sqrt();
                    let _e54 = alpha_v2;
                    let left_e57 = ((1.0f32 - _e54) * length_e53);
                    if (((vertex_e25).flags & 2u32) != 0u32) {
                        let _e65 = largest_v0[t][0];
                        largest_v0[t][0] = _e65.max(left_e57.to_bits());
                        let _e68 = v_v1;
                        note_progress(m, _e68, left_e57);
                    } else {
                        let _e71 = largest_v0[t][1];
                        largest_v0[t][1] = _e71.max(left_e57.to_bits());
                        let _e76 = largest_v0[t][2];
                        let _e77 = alpha_v2;
                        largest_v0[t][2] = _e76.max((_e77 * length_e53).to_bits());
                    }
                    let _e83 = largest_v0[t][3];
                    let _e84 = alpha_v2;
                    largest_v0[t][3] = _e83.max((_e84 * length_e53).to_bits());
                    let _e88 = alpha_v2;
                    let _e90 = v_v1;
                    let _e93 = <f32>::load(m.paths, 4 * (_e90 as usize) + 3);
                    if (_e88 >= _e93) {
                        let _e97 = largest_v0[t][4];
                        largest_v0[t][4] = _e97.max(left_e57.to_bits());
                        if (((vertex_e25).flags & 2u32) != 0u32) {
                            let _e107 = largest_v0[t][5];
                            largest_v0[t][5] = _e107.max(left_e57.to_bits());
                        }
                    }
                    let _e110 = alpha_v2;
                    if (_e110 == 1.0f32) {
                        let _e114 = v_v1;
                        let _e117 = v_v1;
                        let _e119 = <[i32; 4]>::load(m.targets, 4 * (_e117 as usize));
                        Stored::store(_e119, m.positions, 4 * (_e114 as usize));
                    } else {
                        let _e121 = v_v1;
                        let _e123 = alpha_v2;
                        let _e126 = zip(position_e44, displacement_e51.map(|x| (x * _e123)).map(|x| (x as i32)), |x, y| x.wrapping_add(y));
                        Stored::store([(_e126)[0], (_e126)[1], (_e126)[2], 0i32], m.positions, 4 * (_e121 as usize));
                    }
                }
            }
            let _e129 = v_v1;
            v_v1 = _e129.wrapping_add(16776960u32);
        }
        _e133[t] = largest_v0[t];
    }
    find_most(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e133[t]));
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e141 = m.most[0];
            { let old = <u32>::load(m.control, 5); let new = old.max(_e141); Stored::store(new, m.control, 5); old };
            let _e147 = m.most[256];
            { let old = <u32>::load(m.control, 3); let new = old.max(_e147); Stored::store(new, m.control, 3); old };
            let _e153 = m.most[512];
            { let old = <u32>::load(m.control, 7); let new = old.max(_e153); Stored::store(new, m.control, 7); old };
            let _e159 = m.most[768];
            { let old = <u32>::load(m.control, 6); let new = old.max(_e159); Stored::store(new, m.control, 6); old };
            let _e165 = m.most[1024];
            { let old = <u32>::load(m.control, 8); let new = old.max(_e165); Stored::store(new, m.control, 8); old };
            let _e171 = m.most[1280];
            { let old = <u32>::load(m.control, 4); let new = old.max(_e171); Stored::store(new, m.control, 4); old };
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let targets = bound.read(0);
    let vertices = bound.read(1);
    let paths = bound.read(2);
    let alphas = bound.read(3);
    let group_alphas = bound.read(4);
    let mut positions = bound.write(5);
    let mut control = bound.write(6);
    let mut late = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        targets: &targets,
        vertices: &vertices,
        paths: &paths,
        alphas: &alphas,
        group_alphas: &group_alphas,
        positions: &mut positions,
        control: &mut control,
        late: &mut late,
        most: [0u32; 1536],
        shared_overflow: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.most = [0u32; 1536];
        m.shared_overflow = 0u32;
        main(&mut m, group as u32);
    }
}
}
