//! The place of a unit's resources, which an importer gives as a file URI.

use std::path::PathBuf;

use percent_encoding::percent_decode_str;

/// The path of a file URI: `file:///tmp/unit/resources`, `file:/tmp/...`, `file://localhost/tmp/...`.
///
/// # Errors
/// If it is no file URI of this machine; what is wrong and how to correct it.
pub fn path(uri: &str) -> Result<PathBuf, String> {
    const HINT: &str = "give a URI like file:///tmp/unit/resources";
    let scheme = uri
        .get(..5)
        .filter(|scheme| scheme.eq_ignore_ascii_case("file:"));
    let Some(rest) = scheme.and_then(|_| uri.get(5..)) else {
        return Err(format!("{uri:?} is not a file URI; {HINT}"));
    };
    let path = match rest.strip_prefix("//") {
        Some(rest) => rest.strip_prefix("localhost").unwrap_or(rest),
        None => rest,
    };
    if !path.starts_with('/') {
        return Err(format!(
            "{uri:?} names another machine or no absolute path; {HINT}"
        ));
    }
    let path = percent_decode_str(path)
        .decode_utf8()
        .map_err(|_| format!("{uri:?} is not UTF-8; {HINT}"))?;
    // On Windows the drive follows the slash.
    let path = if cfg!(windows) {
        path.trim_start_matches('/')
    } else {
        &path
    };
    Ok(PathBuf::from(path))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn uris_of_files_are_decoded() {
        for uri in [
            "file:///a%20b/c",
            "file:/a%20b/c",
            "FILE://localhost/a%20b/c",
        ] {
            assert_eq!(path(uri), Ok(PathBuf::from("/a b/c")), "{uri}");
        }
        assert_eq!(path("file:///%C3%BC"), Ok(PathBuf::from("/\u{fc}")));
    }

    #[test]
    fn anything_else_is_refused() {
        for uri in [
            "",
            "/a",
            "http://a/b",
            "file://server/share",
            "file:a",
            "file:///%FF",
            "\u{fc}\u{fc}\u{fc}",
        ] {
            assert!(path(uri).is_err(), "{uri}");
        }
    }
}
