//! Fields for ParaView: a VTK image of cells, its data appended raw (VTK file formats, XML ImageData).

use std::fmt::Write;

use crate::contact::half_space::grid::Grid;

/// Fields on a grid at one time as the bytes of a .vti file: one array per (name, values, row by row).
pub fn image(grid: &Grid, time_s: f64, fields: &[(&str, &[f64])]) -> Vec<u8> {
    let (nx, ny) = (grid.cells_x(), grid.cells_y());
    let (dx, dy) = (grid.spacing_x_m(), grid.spacing_y_m());
    let corner = (grid.x_m(0) - 0.5 * dx, grid.y_m(0) - 0.5 * dy);
    let extent = format!("0 {nx} 0 {ny} 0 0");
    let mut head = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        head,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <ImageData WholeExtent=\"{extent}\" Origin=\"{:e} {:e} 0\" Spacing=\"{dx:e} {dy:e} {dx:e}\">\n\
         <FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time_s:e}</DataArray>\
         </FieldData>\n\
         <Piece Extent=\"{extent}\">\n<CellData>\n",
        corner.0, corner.1
    );
    let mut offset = 0;
    for (name, values) in fields {
        let _ = writeln!(
            head,
            "<DataArray type=\"Float64\" Name=\"{name}\" format=\"appended\" offset=\"{offset}\"/>"
        );
        // Each array is preceded by its length in bytes.
        offset += 8 + 8 * values.len();
    }
    head.push_str("</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_");
    let mut bytes = head.into_bytes();
    bytes.reserve(offset + 32);
    for (_, values) in fields {
        bytes.extend_from_slice(&(8 * values.len() as u64).to_le_bytes());
        for value in *values {
            bytes.extend_from_slice(&value.to_le_bytes());
        }
    }
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_array_stands_at_its_offset_behind_its_length() {
        let grid = Grid::new(3, 2, 1e-6, 2e-6).unwrap();
        let (pressure, gap) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.5; 6]);
        let bytes = image(&grid, 7.0, &[("pressure_pa", &pressure), ("gap_m", &gap)]);
        let mark = b"encoding=\"raw\">\n_";
        let start = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        let head = std::str::from_utf8(&bytes[..start]).unwrap();
        assert!(head.contains("WholeExtent=\"0 3 0 2 0 0\" Origin=\"-1.5e-6 -2e-6 0\""));
        assert!(head.contains("Name=\"pressure_pa\" format=\"appended\" offset=\"0\""));
        assert!(head.contains("Name=\"gap_m\" format=\"appended\" offset=\"56\""));
        let number = |at: usize| <[u8; 8]>::try_from(&bytes[start + at..start + at + 8]).unwrap();
        assert_eq!(u64::from_le_bytes(number(0)), 48);
        assert_eq!(f64::from_le_bytes(number(8 + 5 * 8)), 6.0);
        assert_eq!(u64::from_le_bytes(number(56)), 48);
        assert_eq!(f64::from_le_bytes(number(64)), 0.5);
        assert!(bytes.ends_with(b"</VTKFile>\n"));
    }
}
