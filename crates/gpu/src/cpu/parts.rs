//! Partial sums of energies: twin of `shader/shared/parts.wgsl`.

use crate::potential::EnergyParams;

/// Threads of a workgroup, and most workgroups that write parts of one kind.
pub const THREADS: usize = 64;
pub const MOST_WORKGROUPS: usize = 1024;

/// The energy at the reference, its change, its size, and the square of that.
pub type Part = [f32; 4];

/// The part of one element or node.
pub fn part([reference, change, size]: [f32; 3]) -> Part {
    [reference, change, size, size * size]
}

fn plus(a: Part, b: Part) -> Part {
    [0, 1, 2, 3].map(|k| a[k] + b[k])
}

/// Sums the energies of all elements or nodes, workgroup by workgroup.
pub fn put_parts(params: EnergyParams, parts: &mut [Part], energy: impl Fn(usize) -> Part) {
    let workgroups = params.workgroups as usize;
    for group in 0..workgroups {
        let mut values = [[0.0; 4]; THREADS];
        for (t, value) in values.iter_mut().enumerate() {
            let mine = (THREADS * group + t..params.count as usize).step_by(THREADS * workgroups);
            *value = mine.fold([0.0; 4], |sum, k| plus(sum, energy(k)));
        }
        let mut reach = THREADS / 2;
        while reach > 0 {
            for t in 0..reach {
                values[t] = plus(values[t], values[t + reach]);
            }
            reach /= 2;
        }
        parts[params.first as usize + group] = values[0];
    }
}
