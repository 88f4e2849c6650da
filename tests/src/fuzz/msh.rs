//! A small mesh file, to start mutations from.

/// A tetrahedron as a binary Gmsh file of version 4.1 with counts of `size` bytes.
pub fn binary_msh_4(size: usize) -> Vec<u8> {
    let mut file = format!("$MeshFormat\n4.1 1 {size}\n").into_bytes();
    file.extend(1_i32.to_le_bytes());
    file.extend(b"\n$EndMeshFormat\n$Nodes\n");
    let count = |file: &mut Vec<u8>, n: u64| file.extend(&n.to_le_bytes()[..size]);
    let int = |file: &mut Vec<u8>, n: i32| file.extend(n.to_le_bytes());
    [1, 4, 1, 4].iter().for_each(|&n| count(&mut file, n));
    [3, 1, 0].iter().for_each(|&n| int(&mut file, n));
    [4, 1, 2, 3, 4].iter().for_each(|&n| count(&mut file, n));
    for k in 0..4 {
        (1..4).for_each(|axis| file.extend(f64::from(u8::from(k == axis)).to_le_bytes()));
    }
    file.extend(b"\n$EndNodes\n$Elements\n");
    [1, 1, 1, 1].iter().for_each(|&n| count(&mut file, n));
    [3, 1, 4].iter().for_each(|&n| int(&mut file, n));
    [1, 1, 1, 2, 3, 4].iter().for_each(|&n| count(&mut file, n));
    file.extend(b"\n$EndElements\n");
    file
}
