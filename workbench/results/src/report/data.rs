//! Data for a script, as an element of the document.

use maud::{Markup, PreEscaped, Render, html};
use serde::Serialize;

/// Data for a script.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Data(String);

impl Data {
    /// A value as data; `None` if it has no JSON form.
    pub fn of(value: &impl Serialize) -> Option<Self> {
        let text = serde_json::to_string(value).ok()?;
        // A "<" could end the element.
        Some(Self(text.replace('<', "\\u003c")))
    }

    /// Size, bytes.
    pub fn bytes(&self) -> usize {
        self.0.len()
    }
}

impl Render for Data {
    fn render(&self) -> Markup {
        html! { script type="application/json" { (PreEscaped(&self.0)) } }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn data_cannot_end_their_element() {
        let data = Data::of(&json!({ "file": "</script><b>" })).unwrap();
        let text = data.render().into_string();
        assert_eq!(text.matches("</script>").count(), 1);
        let inner = text.split_once('>').unwrap().1;
        let inner = inner.strip_suffix("</script>").unwrap();
        let read: Value = serde_json::from_str(inner).unwrap();
        assert_eq!(read["file"], "</script><b>");
    }
}
