// Written from `shader/search/traverse_tree.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "traverse_tree",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/traverse_tree.wgsl"),
    ],
    workgroup: 64,
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
pub const LEVEL_SHIFT: u32 = 27u32;
pub const GROUP_MASK: u32 = 134217727u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub queries: u32,
    pub count: u32,
    pub kind: u32,
    pub symmetric: u32,
    pub first_row: u32,
    pub lists: u32,
    pub capacity: u32,
    pub levels: u32,
    pub level_first: [[u32; 4]; 3],
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::traverse_tree::*;
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

#[derive(Clone, Copy)]
pub struct Ball {
    pub center: [i32; 3],
    pub radius: i32,
}

impl Ball {
    const ZERO: Self = Self {
        center: [0i32; 3],
        radius: 0i32,
    };
}

impl Stored for Ball {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            center: <[i32; 3]>::load(words, at + 0),
            radius: <i32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.center.store(words, at + 0);
        self.radius.store(words, at + 3);
    }
}

#[derive(Clone, Copy)]
pub struct Slot {
    pub v0: u32,
    pub v1: u32,
    pub v2: u32,
    pub element: u32,
}

impl Slot {
    const ZERO: Self = Self {
        v0: 0u32,
        v1: 0u32,
        v2: 0u32,
        element: 0u32,
    };
}

impl Stored for Slot {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            v0: <u32>::load(words, at + 0),
            v1: <u32>::load(words, at + 1),
            v2: <u32>::load(words, at + 2),
            element: <u32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.v0.store(words, at + 0);
        self.v1.store(words, at + 1);
        self.v2.store(words, at + 2);
        self.element.store(words, at + 3);
    }
}

#[derive(Clone, Copy)]
pub struct NodeBox {
    pub low: [i32; 3],
    pub deformable: u32,
    pub high: [i32; 3],
    pub padding: u32,
}

impl NodeBox {
    const ZERO: Self = Self {
        low: [0i32; 3],
        deformable: 0u32,
        high: [0i32; 3],
        padding: 0u32,
    };
}

impl Stored for NodeBox {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            low: <[i32; 3]>::load(words, at + 0),
            deformable: <u32>::load(words, at + 3),
            high: <[i32; 3]>::load(words, at + 4),
            padding: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.low.store(words, at + 0);
        self.deformable.store(words, at + 3);
        self.high.store(words, at + 4);
        self.padding.store(words, at + 7);
    }
}

#[derive(Clone, Copy)]
pub struct Candidate {
    pub kind_and_a: u32,
    pub b: u32,
}

impl Candidate {
    const ZERO: Self = Self {
        kind_and_a: 0u32,
        b: 0u32,
    };
}

impl Stored for Candidate {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            kind_and_a: <u32>::load(words, at + 0),
            b: <u32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.kind_and_a.store(words, at + 0);
        self.b.store(words, at + 1);
    }
}

struct Memory<'a> {
    params: Params,
    queries: &'a [u32],
    slots: &'a [u32],
    boxes: &'a [u32],
    balls: &'a [u32],
    vertices: &'a [u32],
    starts: &'a mut [u32],
    candidates: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn may_collide(a_a0: Vertex, b_a1: Vertex) -> bool {
    if ((((a_a0).flags & (b_a1).flags) & 1u32) != 0u32) {
        return false;
    }
    if ((a_a0).body == (b_a1).body) {
        return (((a_a0).flags & 4u32) != 0u32);
    }
    let mut local_v0: bool;
    if (((a_a0).groups & (b_a1).mask) != 0u32) {
        local_v0 = (((b_a1).groups & (a_a0).mask) != 0u32);
    } else {
        local_v0 = false;
    }
    let _e31 = local_v0;
    return _e31;
}

pub fn shares_vertex(a_a0: Slot, b_a1: Slot) -> bool {
    let mut local_v0: bool;
    if (!((a_a0).v0 == (b_a1).v0)) {
        local_v0 = ((a_a0).v0 == (b_a1).v1);
    } else {
        local_v0 = true;
    }
    let _e12 = local_v0;
    let mut local_v1: bool;
    if (!_e12) {
        local_v1 = ((a_a0).v0 == (b_a1).v2);
    } else {
        local_v1 = true;
    }
    let _e20 = local_v1;
    let mut local_v2: bool;
    if (!_e20) {
        local_v2 = ((a_a0).v1 == (b_a1).v0);
    } else {
        local_v2 = true;
    }
    let _e28 = local_v2;
    let mut local_v3: bool;
    if (!_e28) {
        local_v3 = ((a_a0).v1 == (b_a1).v1);
    } else {
        local_v3 = true;
    }
    let _e36 = local_v3;
    let mut local_v4: bool;
    if (!_e36) {
        local_v4 = ((a_a0).v1 == (b_a1).v2);
    } else {
        local_v4 = true;
    }
    let _e44 = local_v4;
    let mut local_v5: bool;
    if (!_e44) {
        local_v5 = ((a_a0).v2 == (b_a1).v0);
    } else {
        local_v5 = true;
    }
    let _e52 = local_v5;
    let mut local_v6: bool;
    if (!_e52) {
        local_v6 = ((a_a0).v2 == (b_a1).v1);
    } else {
        local_v6 = true;
    }
    let _e60 = local_v6;
    let mut local_v7: bool;
    if (!_e60) {
        local_v7 = ((a_a0).v2 == (b_a1).v2);
    } else {
        local_v7 = true;
    }
    let _e68 = local_v7;
    return _e68;
}

pub fn first_of(m: &mut Memory<'_>, level_a0: u32) -> u32 {
    let _e9 = m.params.level_first[(level_a0 / 4u32) as usize][(level_a0 % 4u32) as usize];
    return _e9;
}

pub fn find(m: &mut Memory<'_>, q_a0: u32) {
    let mut first_v0: u32 = 0u32;
    let mut low_v1: [i32; 3] = [2147483647i32; 3];
    let mut high_v2: [i32; 3] = [(-2147483647i32); 3];
    let mut k_v3: u32 = 0u32;
    let mut found_v4: u32 = 0u32;
    let mut stack_v5: [u32; 88] = [0u32; 88];
    let mut depth_v6: u32 = 1u32;
    let _e3 = m.params.first_row;
    let row_e4 = _e3.wrapping_add(q_a0);
    let query_e7 = <Slot>::load(m.queries, 4 * (q_a0 as usize));
    if ((query_e7).element == 4294967295u32) {
        let _e13 = m.params.lists;
        if (_e13 == 0u32) {
            Stored::store(0u32, m.starts, 1 * (row_e4 as usize));
        }
        return;
    }
    let _e23 = m.params.lists;
    if (_e23 != 0u32) {
        let _e28 = <u32>::load(m.starts, 1 * (row_e4 as usize));
        first_v0 = _e28;
    }
    let own_e38 = <Vertex>::load(m.vertices, 12 * ((query_e7).v0 as usize));
    'l0: loop {
        'c0: {
            let _e41 = k_v3;
            let _e44 = m.params.count;
            if (_e41 < _e44) {
            } else {
                break 'l0;
            }
            {
                let _e48 = k_v3;
                let v_e51 = (if (_e48 == 1u32) { (query_e7).v1 } else { (query_e7).v0 });
                let ball_e54 = <Ball>::load(m.balls, 4 * (v_e51 as usize));
                let _e59 = <f32>::load(m.vertices, 12 * (v_e51 as usize) + 1);
                let reach_e63 = [(ball_e54).radius.wrapping_add((_e59.ceil() as i32)); 3];
                let _e64 = low_v1;
                low_v1 = zip(_e64, zip((ball_e54).center, reach_e63, |x, y| x.wrapping_sub(y)), |x, y| x.min(y));
                let _e68 = high_v2;
                high_v2 = zip(_e68, zip((ball_e54).center, reach_e63, |x, y| x.wrapping_add(y)), |x, y| x.max(y));
            }
        }
        let _e72 = k_v3;
        k_v3 = _e72.wrapping_add(1u32);
    }
    let any_side_e79 = (((own_e38).flags & 1u32) == 0u32);
    let _e86 = m.params.levels;
    stack_v5[0] = _e86.wrapping_sub(1u32).wrapping_shl(27u32);
    'l1: loop {
        'c1: {
            let _e93 = depth_v6;
            if (_e93 > 0u32) {
            } else {
                break 'l1;
            }
            {
                let _e96 = depth_v6;
                depth_v6 = _e96.wrapping_sub(1u32);
                let _e99 = depth_v6;
                let _e101 = stack_v5[_e99 as usize];
                let level_e103 = _e101.wrapping_shr(27u32);
                let _e104 = depth_v6;
                let _e106 = stack_v5[_e104 as usize];
                let group_e108 = (_e106 & 134217727u32);
                let mut k_v7: u32;
                k_v7 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e111 = k_v7;
                        if (_e111 < 8u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e116 = k_v7;
                            let node_e117 = 8u32.wrapping_mul(group_e108).wrapping_add(_e116);
                            let _e119 = first_of(m, level_e103);
                            let box_e122 = <NodeBox>::load(m.boxes, 8 * (_e119.wrapping_add(node_e117) as usize));
                            let _e124 = high_v2;
                            let mut local_v8: bool;
                            if all(zip((box_e122).low, _e124, |x, y| (x <= y))) {
                                let _e129 = low_v1;
                                local_v8 = all(zip(_e129, (box_e122).high, |x, y| (x <= y)));
                            } else {
                                local_v8 = false;
                            }
                            let overlaps_e134 = local_v8;
                            let mut local_v9: bool;
                            if (!(!overlaps_e134)) {
                                let mut local_v10: bool;
                                if (!any_side_e79) {
                                    local_v10 = ((box_e122).deformable != 0u32);
                                } else {
                                    local_v10 = true;
                                }
                                let _e146 = local_v10;
                                local_v9 = (!_e146);
                            } else {
                                local_v9 = true;
                            }
                            let _e149 = local_v9;
                            if _e149 {
                                break 'c2;
                            }
                            if (level_e103 > 0u32) {
                                let _e152 = depth_v6;
                                stack_v5[_e152 as usize] = (level_e103.wrapping_sub(1u32).wrapping_shl(27u32) | node_e117);
                                let _e159 = depth_v6;
                                depth_v6 = _e159.wrapping_add(1u32);
                                break 'c2;
                            }
                            let other_e164 = <Slot>::load(m.slots, 4 * (node_e117 as usize));
                            let _e167 = m.params.symmetric;
                            let mut local_v11: bool;
                            if (_e167 != 0u32) {
                                local_v11 = ((other_e164).element <= (query_e7).element);
                            } else {
                                local_v11 = false;
                            }
                            let _e176 = local_v11;
                            if _e176 {
                                break 'c2;
                            }
                            let _e177 = shares_vertex(query_e7, other_e164);
                            let mut local_v12: bool;
                            if (!_e177) {
                                let _e184 = <Vertex>::load(m.vertices, 12 * ((other_e164).v0 as usize));
                                let _e185 = may_collide(own_e38, _e184);
                                local_v12 = (!_e185);
                            } else {
                                local_v12 = true;
                            }
                            let _e188 = local_v12;
                            if _e188 {
                                break 'c2;
                            }
                            let _e191 = m.params.lists;
                            let mut local_v13: bool;
                            if (_e191 != 0u32) {
                                let _e196 = first_v0;
                                let _e199 = m.params.capacity;
                                local_v13 = (_e196 < _e199);
                            } else {
                                local_v13 = false;
                            }
                            let _e202 = local_v13;
                            let mut local_v14: bool;
                            if _e202 {
                                let _e205 = found_v4;
                                let _e208 = m.params.capacity;
                                let _e209 = first_v0;
                                local_v14 = (_e205 < _e208.wrapping_sub(_e209));
                            } else {
                                local_v14 = false;
                            }
                            let _e213 = local_v14;
                            if _e213 {
                                let _e215 = first_v0;
                                let _e216 = found_v4;
                                let _e221 = m.params.kind;
                                let _e225 = (_e221.wrapping_shl(29u32) | (query_e7).element);
                                let _e226 = (other_e164).element;
                                Stored::store(Candidate { kind_and_a: _e225, b: _e226 }, m.candidates, 2 * (_e215.wrapping_add(_e216) as usize));
                            }
                            let _e228 = found_v4;
                            found_v4 = _e228.wrapping_add(1u32);
                        }
                    }
                    let _e231 = k_v7;
                    k_v7 = _e231.wrapping_add(1u32);
                }
            }
        }
    }
    let _e236 = m.params.lists;
    if (_e236 == 0u32) {
        let _e241 = found_v4;
        Stored::store(_e241, m.starts, 1 * (row_e4 as usize));
    }
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 0);
    if (_e3 == 0u32) {
        return;
    }
    let mut q_v0: u32;
    q_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = q_v0;
            let _e11 = m.params.queries;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e13 = q_v0;
                find(m, _e13);
            }
        }
        let _e14 = q_v0;
        q_v0 = _e14.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let queries = bound.read(0);
    let slots = bound.read(1);
    let boxes = bound.read(2);
    let balls = bound.read(3);
    let vertices = bound.read(4);
    let mut starts = bound.write(5);
    let mut candidates = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        queries: &queries,
        slots: &slots,
        boxes: &boxes,
        balls: &balls,
        vertices: &vertices,
        starts: &mut starts,
        candidates: &mut candidates,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
