use super::*;

/// The largest error as a share of its bound.
fn worst(encoding: &Encoding, values: &[f64]) -> f64 {
    let back = encoding.packed(values);
    let shares = encoding.bounds.iter().map(|b| b.share(encoding.component, &back, values));
    shares.fold(0.0, f64::max)
}

#[test]
fn decoded_values_are_within_their_bounds() {
    // Errors are largest between two codes, so the values are dense and not aligned with the codes.
    let dense = |i: usize, count: usize| i as f64 / count as f64;
    let mut largest = 0.0;
    let mut hold = |encoding: &Encoding, values: &[f64]| {
        let share = worst(encoding, values);
        assert!(share <= 1.0, "{} of {values:?}: {share} of its bound", encoding.name);
        largest = f64::max(largest, share);
    };
    for encoding in &HORIZON {
        let low = if encoding.component.is_signed() { -FRAC_PI_2 } else { 0.0 };
        for i in 0..=40_009 {
            hold(encoding, &[low + (FRAC_PI_2 - low) * dense(i, 40_009)]);
        }
    }
    for encoding in &SHARE {
        (0..=40_009).for_each(|i| hold(encoding, &[dense(i, 40_009)]));
    }
    for encoding in &BENT_NORMAL {
        for i in 0..=307 {
            for j in 0..=211 {
                let (z, phi) = (dense(i, 307), 2.0 * PI * dense(j, 211));
                let r = (1.0 - z * z).sqrt();
                hold(encoding, &[r * phi.cos(), r * phi.sin(), z, PI * dense(i + j, 518)]);
            }
        }
    }
    for encoding in &COEFFICIENTS {
        (0..=40_009).for_each(|i| {
            let v = 4.0 * dense(i, 40_009) - 2.0;
            hold(encoding, &[v, v * 1e-3, v * 1e-7, v * v]);
        });
    }
    for encoding in &ELLIPSE {
        (0..=4009).for_each(|i| {
            let v = 4.0 * dense(i, 4009);
            hold(encoding, &[v, v - 2.0, 40.0 * v, 1.0 - v]);
        });
    }
    for n in -2..=65_532 {
        let of = |v: i32| f64::from(v);
        let mut texel = [0.0; 2];
        (POINTS[0].encode)(&[of(n), of(65_530 - n)], &mut texel);
        let mut back = [0.0; 2];
        // In f32, as a decoder computes it.
        (POINTS[0].decode)(&texel.map(|t| f64::from(t as f32)), &mut back);
        assert_eq!(back, [of(n), of(65_530 - n)]);
    }
    // The bounds are tight.
    assert!(largest > 0.99, "{largest}");
}

#[test]
fn an_error_of_one_code_exceeds_the_bound() {
    for encoding in HORIZON.iter().chain(&SHARE).filter(|e| e.component.is_normalised()) {
        let step = 1.0 / encoding.component.one();
        let allowed = encoding.bounds[0].absolute(encoding.component);
        let mut value = [0.0];
        (encoding.decode)(&[0.25 + step], &mut value);
        let mut expected = [0.0];
        (encoding.decode)(&[0.25], &mut expected);
        let error = if encoding.name.ends_with("sin") {
            value[0].sin() - expected[0].sin()
        } else {
            value[0] - expected[0]
        };
        assert!(error > 1.5 * allowed, "{}", encoding.name);
    }
}

#[test]
fn codes_are_those_of_vulkan() {
    let bytes = |component: Component, value| {
        let mut bytes = Vec::new();
        component.put(value, &mut bytes);
        bytes
    };
    assert_eq!(bytes(Component::Unorm8, 1.0), [255]);
    assert_eq!(bytes(Component::Snorm8, -1.0), [129]);
    assert_eq!(bytes(Component::Unorm16, 0.5), 32768_u16.to_le_bytes());
    assert_eq!(bytes(Component::Snorm16, -2.0), (-32767_i16).to_le_bytes());
    assert_eq!(bytes(Component::F16, 1.0), 0x3c00_u16.to_le_bytes());
    assert_eq!(bytes(Component::F32, -0.25), (-0.25_f32).to_le_bytes());
}
