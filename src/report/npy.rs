//! Arrays for NumPy: the .npy format, version 1.0, double precision, C order (numpy.lib.format).

/// A matrix of `rows` by `columns` values, given row by row, as the bytes of a .npy file.
pub fn matrix(rows: usize, columns: usize, values: &[f64]) -> Vec<u8> {
    let mut bytes = header(&[rows, columns]);
    bytes.reserve(8 * values.len());
    for value in values {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    bytes
}

/// The values of a file that [`matrix`] has written of so many rows and columns; `None` of another one.
pub fn values(rows: usize, columns: usize, bytes: &[u8]) -> Option<Vec<f64>> {
    let data = bytes.strip_prefix(&header(&[rows, columns])[..])?;
    let (values, rest) = data.as_chunks();
    let is_whole = rest.is_empty() && Some(values.len()) == rows.checked_mul(columns);
    is_whole.then(|| {
        values
            .iter()
            .map(|value| f64::from_le_bytes(*value))
            .collect()
    })
}

/// How the .npy file of an array of this shape begins; the values follow, the last index fastest, each in eight bytes, little endian.
pub fn header(shape: &[usize]) -> Vec<u8> {
    const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
    /// The data begin at a multiple of this.
    const ALIGNMENT: usize = 64;
    let sides: String = shape.iter().map(|side| format!("{side}, ")).collect();
    // A tuple of one has its comma; one of more ends without.
    let sides = match shape {
        [_] => sides.trim_end(),
        _ => sides.trim_end_matches(", "),
    };
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({sides}), }}");
    // Magic, two bytes of length, header, line feed.
    let unpadded = MAGIC.len() + 2 + header.len() + 1;
    let total = unpadded.next_multiple_of(ALIGNMENT);
    let length = (total - MAGIC.len() - 2) as u16;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&length.to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    bytes.resize(total - 1, b' ');
    bytes.push(b'\n');
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_padded_to_64_bytes_and_the_data_follow_bit_for_bit() {
        for (rows, columns) in [(1, 1), (2, 3), (1024, 7)] {
            let values: Vec<f64> = (0..rows * columns).map(|i| 0.1 * i as f64).collect();
            let bytes = matrix(rows, columns, &values);
            assert_eq!(super::values(rows, columns, &bytes), Some(values.clone()));
            assert_eq!(super::values(rows + 1, columns, &bytes), None);
            assert_eq!(
                super::values(rows, columns, &bytes[..bytes.len() - 1]),
                None
            );
            let header = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
            assert_eq!((10 + header) % 64, 0);
            let text = std::str::from_utf8(&bytes[10..10 + header]).unwrap();
            assert!(text.contains(&format!("'shape': ({rows}, {columns})")));
            assert!(text.ends_with('\n'));
            let data = bytes[10 + header..].chunks_exact(8);
            let read: Vec<f64> = data
                .map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap()))
                .collect();
            assert_eq!(read, values);
        }
    }
}
