//! Twin of `shader/sum_energy.wgsl`.

use super::parts::put_parts;
use crate::bound::Bound;

pub fn bound(buffers: Bound<'_>) {
    let addends = buffers.read(0);
    put_parts(buffers.params(), &mut buffers.write(1), |k| addends[k]);
}
