//! The description in FMI 3.0 (section 2.4).

use std::fmt::Write;

use super::{Description, Variable, escaped};

/// The description in FMI 3.0. The value references are those of FMI 2.0, and time is the last variable.
pub(super) fn xml(unit: &Description<'_>) -> String {
    let variables = unit.variables();
    let mut list = String::new();
    for (reference, variable) in variables.iter().enumerate() {
        let Variable { name, description, is_input, unit: measured_in } = variable;
        let attributes = if *is_input {
            "causality=\"input\" variability=\"continuous\" start=\"0\""
        } else {
            "causality=\"output\" variability=\"continuous\" initial=\"calculated\""
        };
        // Writing to a text cannot fail.
        let _ = writeln!(
            list,
            "    <Float64 name=\"{}\" valueReference=\"{reference}\" description=\"{}\" unit=\"{measured_in}\" {attributes}/>",
            escaped(name),
            escaped(description)
        );
    }
    let references = unit.zones.len()..variables.len();
    let outputs: String =
        references.clone().map(|reference| format!("    <Output valueReference=\"{reference}\"/>\n")).collect();
    let unknowns: String =
        references.map(|reference| format!("    <InitialUnknown valueReference=\"{reference}\"/>\n")).collect();
    let (title, identifier, guid, summary) = (escaped(unit.title), unit.identifier, unit.guid, unit.summary());
    let (step_s, stop_s, version) = (unit.step_s, unit.stop_s, env!("CARGO_PKG_VERSION"));
    let time = variables.len();
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{title}" instantiationToken="{guid}"
    generationTool="Interplay {version}" variableNamingConvention="flat"
    description="{summary}">
  <CoSimulation modelIdentifier="{identifier}" canBeInstantiatedOnlyOncePerProcess="false"
      canGetAndSetFMUState="true" canSerializeFMUState="true" providesDirectionalDerivatives="false"
      canHandleVariableCommunicationStepSize="false" fixedInternalStepSize="{step_s}" hasEventMode="false"/>
  <UnitDefinitions>
    <Unit name="s"><BaseUnit s="1"/></Unit>
    <Unit name="kW"><BaseUnit kg="1" m="2" s="-3" factor="1000"/></Unit>
    <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError" description="Errors"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="{stop_s}" stepSize="{step_s}"/>
  <ModelVariables>
{list}    <Float64 name="time" valueReference="{time}" description="Time since the first midnight" unit="s" causality="independent" variability="continuous"/>
  </ModelVariables>
  <ModelStructure>
{outputs}{unknowns}  </ModelStructure>
</fmiModelDescription>
"#
    )
}
