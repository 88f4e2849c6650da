use super::*;

#[test]
fn every_name_gives_a_valid_material() {
    for name in ClothMaterial::NAMES {
        let material = ClothMaterial::named(name).expect(name);
        material.validate().expect(name);
    }
    assert_eq!(ClothMaterial::named("chain mail"), None);
}

#[test]
fn every_fabric_can_hang_without_reaching_its_stretch_limit() {
    let limits = ClothMaterial::NAMES.map(|name| ClothMaterial::named(name).expect(name).stretch_limit);
    assert_eq!(limits, [1.05, 1.06, 1.2, 1.05, 1.05, 1.05]);
    for name in ClothMaterial::NAMES {
        let material = ClothMaterial::named(name).expect(name);
        // Strain at the upper end of 2 m of fabric, from weight and stiffness.
        let strain = material.density * 9.81 * 2.0 / material.stretch_stiffness;
        assert!(strain < material.stretch_limit - 1.0, "{name} hangs from its limit: {strain}");
    }
    assert_eq!(ClothMaterial::from_young_modulus(1.0, 1e6, 0.3, 1e-3).stretch_limit, f64::INFINITY);
    for bad in [1.0, 0.5, f64::NAN, f64::NEG_INFINITY] {
        let material = ClothMaterial { stretch_limit: bad, ..ClothMaterial::cotton() };
        assert_eq!(material.validate().expect_err("out of range").len(), 1, "{bad}");
    }
    ClothMaterial { stretch_limit: f64::INFINITY, ..ClothMaterial::cotton() }.validate().expect("no limit");
}

#[test]
fn all_bad_values_are_named() {
    let material = ClothMaterial {
        density: 0.0,
        stretch_stiffness: f64::NAN,
        bend_stiffness: -1.0,
        poisson_ratio: 1.0,
        weft_stiffness: Some(0.0),
        shear_stiffness: Some(-1.0),
        warp_direction: Vector::zeros(),
        stretch_limit: 1.0,
        thickness: f64::INFINITY,
        stretch_damping: f64::NAN,
        bend_damping: -0.1,
        rest_shape: RestShape::Flat,
    };
    let errors = material.validate().expect_err("every number is out of range");
    assert_eq!(
        errors.to_string(),
        "density = 0 kg/m2: must be finite and above 0\n\
         stretch_stiffness = NaN N/m: must be finite and at least 0\n\
         weft_stiffness = 0 N/m: must be finite and above 0\n\
         shear_stiffness = -1 N/m: must be finite and above 0\n\
         warp_direction = [0.0, 0.0, 0.0]: must be finite and not zero\n\
         poisson_ratio = 1: must lie between -1 and 1\n\
         bend_stiffness = -1 N m: must be finite and at least 0\n\
         thickness = inf m: must be finite and above 0\n\
         stretch_limit = 1: must be above 1, inf included\n\
         stretch_damping = NaN s: must be finite and at least 0\n\
         bend_damping = -0.1 s: must be finite and at least 0"
    );
}

#[test]
fn a_material_survives_toml_and_unknown_keys_are_refused() {
    let material = ClothMaterial {
        weft_stiffness: Some(1500.0),
        rest_shape: RestShape::Initial,
        stretch_limit: f64::INFINITY,
        ..ClothMaterial::denim()
    };
    let text = toml::to_string(&material).expect("serialize");
    assert_eq!(toml::from_str::<ClothMaterial>(&text).expect("parse"), material);
    assert!(toml::from_str::<ClothMaterial>("densty = 1.0").is_err());
    // Keys that are left out have the values of the default material.
    let partial: ClothMaterial = toml::from_str("density = 0.5").expect("parse");
    assert_eq!(partial, ClothMaterial { density: 0.5, ..ClothMaterial::default() });
}
