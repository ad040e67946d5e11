//! What a unit carries in its `resources` folder, and the component that it makes.

use std::path::Path;

use hitch_controller_host::calibration_file;
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use uuid::Uuid;

use crate::component::Component;
use crate::controller::ControllerComponent;
use crate::description::{self, About};
use crate::kind::Kind;
use crate::plant::PlantComponent;

/// Space of the names whose ids are the units' checksums.
const SPACE: Uuid = Uuid::from_u128(0x6d1f_4b52_9c1e_4c3a_8f57_1b0a_2e77_c9d4);

/// A component with the checksum and the description of its unit.
pub struct Content {
    /// What is simulated.
    pub component: Box<dyn Component>,
    /// Checksum of the file and of the description.
    pub guid: String,
    /// Text of `modelDescription.xml`.
    pub description: String,
}

impl Content {
    /// The content of a model file or a calibration file, with its description.
    ///
    /// # Errors
    /// A fault in the file, with line and column.
    pub fn parse(kind: Kind, file: &SourceFile) -> Result<Self, InputError> {
        let (component, name): (Box<dyn Component>, String) = match kind {
            Kind::Plant => {
                let model = hitch_model_file::parse(file)?;
                let name = format!("hitch plant {}", model.name);
                (Box::new(PlantComponent::new(model)), name)
            }
            Kind::Controller => {
                let calibration = calibration_file::parse(file)?;
                let component = ControllerComponent::new(calibration);
                (Box::new(component), "hitch controller".to_owned())
            }
        };
        let name = name.as_str();
        let described = |guid: &str| {
            let about = About { kind, name, guid };
            description::write(about, component.variables())
        };
        let hashed = format!("{}\n{}", described(""), file.text);
        let guid = format!("{{{}}}", Uuid::new_v5(&SPACE, hashed.as_bytes()));
        Ok(Self {
            description: described(&guid),
            guid,
            component,
        })
    }

    /// The content of a unit's `resources` folder.
    ///
    /// # Errors
    /// If it has no file of a unit, or the file is wrong.
    pub fn read(resources: &Path) -> Result<Self, InputError> {
        let there = Kind::ALL
            .into_iter()
            .find(|kind| resources.join(kind.file()).exists());
        let Some(kind) = there else {
            let [model, calibration] = Kind::ALL.map(Kind::file);
            return Err(InputError::of_file(
                resources,
                format!("has neither {model} nor {calibration}"),
                "unpack the whole unit",
            ));
        };
        let file = SourceFile::read(&resources.join(kind.file()))?;
        Self::parse(kind, &file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn content(text: &str) -> Content {
        let file = SourceFile {
            path: "model.toml".into(),
            text: text.to_owned(),
        };
        Content::parse(Kind::Plant, &file).unwrap()
    }

    #[test]
    fn the_checksum_is_that_of_the_content() {
        let text = hitch_model_file::to_toml(&hitch_model_file::dynamic());
        let [once, again, other] =
            [&text, &text, &format!("{text}\n# changed\n")].map(|text| content(text).guid);
        assert_eq!(once, again);
        assert_ne!(once, other);
    }

    #[test]
    fn a_folder_without_content_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let error = Content::read(folder.path()).map(|_| ()).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("neither model.toml nor calibration.toml")
        );
    }
}
