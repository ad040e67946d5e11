//! A measured linkage from a text table.

use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_plant::{LinkageTable, LinkageTableError};

use super::number_table::{NumberTable, Wanted};

const EXAMPLE: &str = "travel_mm,angle_deg,height_mm";
const LENGTHS: &[&str] = &["mm", "cm", "m"];

const COLUMNS: [Wanted; 3] = [
    Wanted {
        quantity: "travel",
        words: &["travel", "stroke", "hub", "weg"],
        units: LENGTHS,
    },
    Wanted {
        quantity: "angle",
        words: &["angle", "winkel"],
        units: &["deg", "rad"],
    },
    Wanted {
        quantity: "height",
        words: &["height", "h\u{f6}he", "hoehe"],
        units: LENGTHS,
    },
];

/// Reads a measured linkage: a header with a travel and a height in mm, cm or m and an angle in deg or rad, and one row
/// per point. Words in the names tell travel and height apart.
///
/// # Errors
/// A fault in the table, by line.
pub fn of(source: &SourceFile) -> Result<LinkageTable, InputError> {
    let table = NumberTable::read(source, &COLUMNS, EXAMPLE)?;
    let [travel_m, angle_rad, height_m] = table.columns;
    LinkageTable::new(travel_m, angle_rad, height_m).map_err(|fault| match fault {
        LinkageTableError::Order { index } => source.error_at(
            table.bytes[index],
            "travel, angle or height does not rise",
            "sort the rows by travel; the angle grows as the hitch rises",
        ),
        LinkageTableError::Length { .. } => source.error(fault.to_string(), "add points"),
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn read_text(text: &str) -> Result<LinkageTable, InputError> {
        of(&SourceFile::any_of(
            Path::new("table.csv"),
            text.as_bytes(),
        )?)
    }

    #[test]
    fn tables_of_any_dialect_are_read() {
        let english =
            read_text("travel_mm,angle_deg,height_mm\n0,45,-850\n80,90,-520\n160,136,-170\n");
        let german = read_text(
            "Hub [cm];Winkel [deg];H\u{f6}he [m]\n0;45,0;-0,85\n8;90,0;-0,52\n16;136,0;-0,17\n",
        );
        let (english, german) = (english.expect("a table"), german.expect("a table"));
        assert_eq!(english.span_m(), (0.0, 0.16));
        for (a, b) in english.height_m().iter().zip(german.height_m()) {
            assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn faults_are_told_by_line() {
        let fault = |text: &str| read_text(text).expect_err("a fault");
        let order = fault("travel_mm,angle_deg,height_mm\n0,45,1\n80,40,2\n160,136,3\n");
        assert_eq!(order.place.map(|place| place.line), Some(3), "{order}");
        let height = fault("travel_mm,angle_deg\n0,45\n80,90\n160,136\n");
        assert!(
            height.to_string().contains("no column is a height"),
            "{height}"
        );
    }
}
