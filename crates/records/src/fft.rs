//! Discrete Fourier transform of 2^k values, radix 2.
//!
//! Written out so that the order of operations, and with it every bit, is the same on every machine:
//! libraries choose other instructions on other processors.

/// A complex number as real and imaginary part.
pub(crate) type Complex = [f64; 2];

fn multiply(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Transforms in place: X_k = Σ x_n exp(−2πi·kn/N). The length must be a power of two.
pub(crate) fn forward(values: &mut [Complex]) {
    transform(values, -1.0);
}

/// Inverse of [`forward`].
pub(crate) fn inverse(values: &mut [Complex]) {
    transform(values, 1.0);
    let scale = 1.0 / values.len() as f64;
    for value in values {
        *value = [value[0] * scale, value[1] * scale];
    }
}

/// The transform of real samples padded with zeros to `length`, a power of two no shorter than they are.
pub(crate) fn of_real(samples: &[f64], length: usize) -> Vec<Complex> {
    let padding = std::iter::repeat_n(0.0, length.saturating_sub(samples.len()));
    let mut values: Vec<Complex> = samples.iter().copied().chain(padding).map(|re| [re, 0.0]).collect();
    forward(&mut values);
    values
}

fn transform(values: &mut [Complex], sign: f64) {
    let length = values.len();
    assert!(length.is_power_of_two(), "the length of a transform is a power of two");
    reverse_bits(values);
    let turn = |k: usize, n: usize| {
        let (sin, cos) = (sign * std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        [cos, sin]
    };
    let mut half = 1;
    while half < length {
        let factors: Vec<Complex> = (0..half).map(|k| turn(k, 2 * half)).collect();
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((a, b), &factor) in low.iter_mut().zip(high).zip(&factors) {
                let turned = multiply(*b, factor);
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
}

fn reverse_bits(values: &mut [Complex]) {
    let bits = values.len().trailing_zeros();
    for i in 0..values.len() {
        let j = i.reverse_bits() >> (usize::BITS - bits.max(1));
        if bits > 0 && i < j {
            values.swap(i, j);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_transform_of_a_cosine_is_two_lines_and_comes_back() {
        let n = 64;
        let wave: Vec<f64> =
            (0..n).map(|i| (std::f64::consts::TAU * 5.0 * i as f64 / n as f64).cos()).collect();
        let mut values = of_real(&wave, n);
        for (k, value) in values.iter().enumerate() {
            let expected = if k == 5 || k == n - 5 { n as f64 / 2.0 } else { 0.0 };
            // Rounding of log2(64) additions.
            assert!((value[0] - expected).abs() < 1e-12 && value[1].abs() < 1e-12, "{k}: {value:?}");
        }
        inverse(&mut values);
        assert!(values.iter().zip(&wave).all(|(v, w)| (v[0] - w).abs() < 1e-14));
    }
}
