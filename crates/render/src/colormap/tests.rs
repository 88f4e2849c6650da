use super::*;

/// The entries 0, 64, 128, 192 and 255 of the original table (matplotlib's `_cm_listed.py`, CC0).
#[test]
fn follows_the_original_table() {
    let table = [
        (0.0, [0.267_004, 0.004_874, 0.329_415]),
        (64.0 / 255.0, [0.229_739, 0.322_361, 0.545_706]),
        (128.0 / 255.0, [0.127_568, 0.566_949, 0.550_556]),
        (192.0 / 255.0, [0.369_214, 0.788_888, 0.382_914]),
        (1.0, [0.993_248, 0.906_157, 0.143_936]),
    ];
    for (t, expected) in table {
        let color = viridis(t);
        for c in 0..3 {
            assert!((color[c] - expected[c]).abs() < 0.014, "t = {t}: {color:?} for {expected:?}");
        }
    }
}

/// Perceived lightness grows steadily, so that the map can be read in gray as well.
#[test]
fn grows_lighter() {
    let luminance = |t: f64| {
        let [r, g, b] = viridis(t).map(to_linear);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    for k in 0..100 {
        let (a, b) = (luminance(k as f64 / 100.0), luminance((k + 1) as f64 / 100.0));
        assert!(b > a, "t = {k} %: {b} after {a}");
    }
    assert_eq!(viridis(-3.0), viridis(0.0));
    assert_eq!(viridis(7.0), viridis(1.0));
}

#[test]
fn transfer_functions_are_inverse() {
    for k in 0..=255 {
        let srgb = f64::from(k) / 255.0;
        assert!((to_srgb(to_linear(srgb)) - srgb).abs() < 1e-6);
    }
}
