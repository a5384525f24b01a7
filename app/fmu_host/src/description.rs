//! The description of a unit: `modelDescription.xml` of FMI 2.0.

use roxmltree::{Document, Node};

#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Its identity, which its library checks.
    pub guid: String,
    /// The name of its library, without the extension.
    pub library: String,
    pub variables: Vec<UnitVariable>,
}

/// An input or an output of a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitVariable {
    pub name: String,
    /// Its value reference in the library.
    pub reference: u32,
    pub causality: Causality,
    pub kind: VariableKind,
    /// Its unit, such as `K`; none where it is not stated.
    pub unit: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The program that runs the unit.
    Input,
    Output,
}

/// The kinds of values that this program reads and writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    Real,
    /// Yes or no.
    Boolean,
}

impl Description {
    /// Reads a description. Inputs and outputs that are neither numbers nor booleans are left out.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        let document = Document::parse(text).map_err(|error| format!("its description is not XML: {error}"))?;
        let root = document.root_element();
        let version = root.attribute("fmiVersion").unwrap_or("none");
        if version != "2.0" {
            return Err(format!("it is of FMI version {version}; wanted is 2.0"));
        }
        let guid = root.attribute("guid").ok_or("its description has no `guid`")?;
        let co_simulation = root.children().find(|node| node.has_tag_name("CoSimulation"));
        let co_simulation = co_simulation.ok_or("it is not made for co-simulation")?;
        if co_simulation.attribute("needsExecutionTool") == Some("true") {
            return Err("it needs the tool that exported it".to_owned());
        }
        let library = co_simulation.attribute("modelIdentifier").ok_or("its description has no `modelIdentifier`")?;
        let word = |character: char| character.is_ascii_alphanumeric() || "_-".contains(character);
        if library.is_empty() || !library.chars().all(word) {
            return Err(format!("`{library}` is not a valid name of a library"));
        }
        let variables = root.children().find(|node| node.has_tag_name("ModelVariables"));
        let variables = variables.into_iter().flat_map(|list| list.children()).filter_map(variable).collect();
        Ok(Self { guid: guid.to_owned(), library: library.to_owned(), variables })
    }
}

fn variable(node: Node<'_, '_>) -> Option<UnitVariable> {
    let causality = match node.attribute("causality")? {
        "input" => Causality::Input,
        "output" => Causality::Output,
        _ => return None,
    };
    let value = node.children().find(Node::is_element)?;
    let kind = match value.tag_name().name() {
        "Real" => VariableKind::Real,
        "Boolean" => VariableKind::Boolean,
        _ => return None,
    };
    Some(UnitVariable {
        name: node.attribute("name")?.to_owned(),
        reference: node.attribute("valueReference")?.parse().ok()?,
        causality,
        kind,
        unit: value.attribute("unit").map(str::to_owned),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_and_outputs_are_read_from_the_description() {
        let text = r#"<fmiModelDescription fmiVersion="2.0" guid="{1}"><CoSimulation modelIdentifier="case"/><ModelVariables>
            <ScalarVariable name="oveY_u" valueReference="3" causality="input"><Real unit="1"/></ScalarVariable>
            <ScalarVariable name="oveY_activate" valueReference="4" causality="input"><Boolean/></ScalarVariable>
            <ScalarVariable name="inner" valueReference="5" causality="local"><Real/></ScalarVariable>
            <ScalarVariable name="reaT_y" valueReference="6" causality="output"><Real unit="K"/></ScalarVariable>
            </ModelVariables></fmiModelDescription>"#;
        let found = Description::parse(text).expect("a description");
        assert_eq!((found.guid.as_str(), found.library.as_str(), found.variables.len()), ("{1}", "case", 3));
        assert_eq!((found.variables[1].kind, found.variables[1].reference), (VariableKind::Boolean, 4));
        assert_eq!(found.variables[2].unit.as_deref(), Some("K"));
    }

    #[test]
    fn units_of_other_versions_and_kinds_are_refused_with_the_reason() {
        for (text, said) in [
            ("nothing", "is not XML"),
            (r#"<a fmiVersion="3.0"/>"#, "version 3.0"),
            (r#"<a fmiVersion="2.0" guid="1"><ModelExchange modelIdentifier="x"/></a>"#, "co-simulation"),
            (r#"<a fmiVersion="2.0" guid="1"><CoSimulation modelIdentifier="../x"/></a>"#, "valid name of a library"),
        ] {
            let error = Description::parse(text).expect_err(text);
            assert!(error.contains(said), "{error}");
        }
    }
}
