//! Joins modules into one script, for a document that cannot load files.

use std::fmt::Write as _;

/// One module script with the modules, each in its own scope. A module may only import names from earlier ones, and exports
/// declarations only.
pub fn bundle<'a>(modules: impl IntoIterator<Item = (&'a str, &'a str)>) -> String {
    let mut joined = String::from("const modules = {};\n");
    for (name, text) in modules {
        let mut exported = Vec::new();
        let mut body = String::new();
        for line in text.lines() {
            let line = match line.strip_prefix("export ") {
                Some(declaration) => {
                    exported.extend(declared(declaration));
                    declaration
                }
                None => line,
            };
            // Writing to a string cannot fail.
            let _ = match imported(line) {
                Some((names, from)) => writeln!(body, "const {names} = modules[\"{from}\"];"),
                None => writeln!(body, "{line}"),
            };
        }
        let names = exported.join(", ");
        let _ = write!(
            joined,
            "modules[\"{name}\"] = (() => {{\n{body}return {{ {names} }};\n}})();\n"
        );
    }
    joined
}

/// Names in braces and the module of an import; a name of its own, `a as b`, is `a: b` where an object is taken apart.
fn imported(line: &str) -> Option<(String, &str)> {
    let (names, from) = line.strip_prefix("import ")?.split_once(" from \"./")?;
    Some((names.replace(" as ", ": "), from.strip_suffix("\";")?))
}

/// The name that a declaration defines.
fn declared(declaration: &str) -> Option<&str> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut words = declaration
        .split(|c| !word(c))
        .filter(|part| !part.is_empty());
    words.find(|part| !["async", "function", "const", "class"].contains(part))
}

#[cfg(test)]
mod tests {
    use super::super::MODULES;
    use super::*;

    #[test]
    fn modules_keep_their_scopes() {
        let first =
            "const own = 1;\nexport const SHOWN_S = own;\nexport async function draw(at) {\n}\n";
        let second =
            "import { draw, SHOWN_S as long_s } from \"./a.js\";\nconst own = 2;\ndraw(own);\n";
        let expected = "const modules = {};\n\
            modules[\"a.js\"] = (() => {\nconst own = 1;\nconst SHOWN_S = own;\nasync function draw(at) {\n}\n\
            return { SHOWN_S, draw };\n})();\n\
            modules[\"b.js\"] = (() => {\nconst { draw, SHOWN_S: long_s } = modules[\"a.js\"];\nconst own = 2;\ndraw(own);\n\
            return {  };\n})();\n";
        assert_eq!(bundle([("a.js", first), ("b.js", second)]), expected);
    }

    #[test]
    fn no_import_of_a_shared_module_remains() {
        let joined = bundle(MODULES);
        let remaining = joined
            .lines()
            .find(|line| line.starts_with("import ") || line.starts_with("export "));
        assert_eq!(remaining, None);
        assert!(
            joined
                .contains("return { library, loadLibrary, drawRun, redrawRun, zoomRun, readable, sampleAt, frame, ordinate };")
        );
    }
}
