//! Series of numbers in few bytes, every bit kept: a smooth series differs little from what its last values foretell.
//!
//! The bits of the numbers, taken as whole numbers, are differenced as often as makes them smallest, and each difference is written
//! with as many bytes as it needs, seven bits in a byte. A cycle of 200 double precision samples takes about 5 bytes a sample.

/// Differences are taken this often at most; beyond, they grow with the rounding of the numbers.
const HIGHEST_ORDER: usize = 10;

/// Packs double precision numbers.
pub fn doubles(values: &[f64]) -> Vec<u8> {
    pack(values.iter().map(|value| value.to_bits() as i64).collect())
}

/// Packs numbers of single precision, some of which may be absent.
pub fn optional_singles(values: impl Iterator<Item = Option<f32>>) -> Vec<u8> {
    let bits = values.map(|value| i64::from(value.unwrap_or(f32::NAN).to_bits() as i32));
    pack(bits.collect())
}

/// Packs double precision numbers, some of which may be absent.
pub fn optional_doubles(values: &[Option<f64>]) -> Vec<u8> {
    // No number of a record is NaN, which can so stand for none.
    let bits = values
        .iter()
        .map(|value| value.unwrap_or(f64::NAN).to_bits() as i64);
    pack(bits.collect())
}

/// What [`doubles`] has packed; `None` of anything else.
pub fn to_doubles(bytes: &[u8]) -> Option<Vec<f64>> {
    let bits = unpack(bytes)?.into_iter();
    Some(bits.map(|bits| f64::from_bits(bits as u64)).collect())
}

/// What [`optional_doubles`] has packed; `None` of anything else.
pub fn to_optional_doubles(bytes: &[u8]) -> Option<Vec<Option<f64>>> {
    let values = to_doubles(bytes)?.into_iter();
    Some(values.map(|v| (!v.is_nan()).then_some(v)).collect())
}

/// What [`optional_singles`] has packed; `None` of anything else.
pub fn to_optional_singles(bytes: &[u8]) -> Option<Vec<Option<f32>>> {
    let bits = unpack(bytes)?.into_iter();
    let values = bits.map(|bits| f32::from_bits(bits as u32));
    Some(values.map(|v| (!v.is_nan()).then_some(v)).collect())
}

fn pack(mut bits: Vec<i64>) -> Vec<u8> {
    let (mut best, mut order) = (bits.clone(), 0);
    let mut fewest = size(&bits);
    for next in 1..=HIGHEST_ORDER.min(bits.len().saturating_sub(1)) {
        for i in (next..bits.len()).rev() {
            bits[i] = bits[i].wrapping_sub(bits[i - 1]);
        }
        let bytes = size(&bits);
        if bytes < fewest {
            (fewest, order) = (bytes, next);
            best.clone_from(&bits);
        }
    }
    let mut packed = Vec::with_capacity(1 + fewest);
    packed.push(order as u8);
    for value in best {
        let mut rest = zigzag(value);
        while rest >= 0x80 {
            packed.push(rest as u8 | 0x80);
            rest >>= 7;
        }
        packed.push(rest as u8);
    }
    packed
}

/// Bytes that differences take.
fn size(differences: &[i64]) -> usize {
    let bytes = |value: i64| (64 - (zigzag(value) | 1).leading_zeros() as usize).div_ceil(7);
    differences.iter().map(|value| bytes(*value)).sum()
}

/// Numbers near zero of either sign as small ones.
fn zigzag(value: i64) -> u64 {
    ((value << 1) ^ (value >> 63)) as u64
}

fn unpack(bytes: &[u8]) -> Option<Vec<i64>> {
    let (order, bytes) = bytes.split_first()?;
    let order = usize::from(*order);
    let (mut bits, mut value, mut shift) = (Vec::with_capacity(bytes.len() / 4), 0_u64, 0);
    for byte in bytes {
        let part = u64::from(byte & 0x7f);
        if shift > 63 || part << shift >> shift != part {
            return None;
        }
        value |= part << shift;
        shift += 7;
        if byte & 0x80 == 0 {
            bits.push((value >> 1) as i64 ^ -((value & 1) as i64));
            (value, shift) = (0, 0);
        }
    }
    if shift > 0 || order > HIGHEST_ORDER {
        return None;
    }
    for from in (1..=order).rev() {
        for i in from..bits.len() {
            bits[i] = bits[i].wrapping_add(bits[i - 1]);
        }
    }
    Some(bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(count: usize) -> Vec<f64> {
        let phase = |k: usize| std::f64::consts::TAU * k as f64 / 200.0;
        (0..count).map(|k| 1e-5 + 3e-6 * phase(k).sin()).collect()
    }

    #[test]
    fn every_bit_comes_back_of_any_series() {
        let odd = [
            0.0,
            -0.0,
            f64::INFINITY,
            f64::MIN,
            f64::MAX,
            5e-324,
            -1.5,
            1e300,
        ];
        for values in [vec![], vec![0.1], sine(2), sine(201), odd.to_vec()] {
            let found = to_doubles(&doubles(&values)).unwrap();
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&found), bits(&values));
            let optional: Vec<_> = values.iter().map(|v| (*v > 0.0).then_some(*v)).collect();
            let packed = optional_doubles(&optional);
            assert_eq!(to_optional_doubles(&packed).unwrap(), optional);
            let singles: Vec<_> = optional.iter().map(|v| v.map(|v| v as f32)).collect();
            let packed = optional_singles(singles.iter().copied());
            assert_eq!(to_optional_singles(&packed).unwrap(), singles);
        }
    }

    #[test]
    fn a_smooth_cycle_takes_half_its_bytes_and_uniform_times_a_fifth() {
        let packed = doubles(&sine(201)).len();
        assert!(packed < 201 * 4, "{packed}");
        let times: Vec<f64> = (0..201).map(|k| 0.3 * f64::from(k)).collect();
        let packed = doubles(&times).len();
        assert!(packed < 201 * 8 / 5, "{packed}");
    }

    #[test]
    fn bytes_of_something_else_are_refused_or_numbers_but_never_a_panic() {
        let whole = doubles(&sine(9));
        assert_eq!(to_doubles(&[]), None);
        assert_eq!(to_doubles(&whole[..whole.len() - 1]), None);
        for byte in 0..whole.len() {
            for bit in 0..8 {
                let mut changed = whole.clone();
                changed[byte] ^= 1 << bit;
                let _ = to_doubles(&changed);
            }
        }
        assert_eq!(
            to_doubles(&[
                0, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f
            ]),
            None
        );
    }
}
