//! The file with the key of a machine: 64 hexadecimal digits.

use std::path::Path;

use hitch_protocols::key::{SECRET_BYTES, Secret};

use hitch_output::error::Error;

/// Reads the key.
///
/// # Errors
/// If the file cannot be read, or holds no key.
pub fn read_key(path: &Path) -> Result<Secret, Error> {
    let shown = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| {
        Error::Usage(format!(
            "{shown}: cannot be read: {error}; give the file with the key of this machine"
        ))
    })?;
    from_digits(text.trim()).ok_or_else(|| {
        Error::Usage(format!(
            "{shown}: is no key; give a file with {} hexadecimal digits, as `openssl rand -hex {SECRET_BYTES}` prints",
            2 * SECRET_BYTES
        ))
    })
}

fn from_digits(text: &str) -> Option<Secret> {
    let digits: Option<Vec<u32>> = text.chars().map(|digit| digit.to_digit(16)).collect();
    let digits = digits?;
    let (pairs, []) = digits.as_chunks::<2>() else {
        return None;
    };
    let bytes: Vec<u8> = pairs
        .iter()
        .map(|[high, low]| (16 * high + low) as u8)
        .collect();
    Secret::new(bytes.try_into().ok()?)
}

#[cfg(test)]
mod tests {
    use super::from_digits;

    #[test]
    fn a_key_has_64_hexadecimal_digits() {
        let good = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1F";
        assert!(from_digits(good).is_some());
        for bad in [
            "",
            "00",
            &good[1..],
            &format!("{good}00"),
            &good.replace('a', "g"),
        ] {
            assert!(from_digits(bad).is_none(), "{bad}");
        }
        assert!(from_digits(&"0".repeat(64)).is_none(), "all bytes equal");
    }
}
