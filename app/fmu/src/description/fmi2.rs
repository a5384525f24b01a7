//! The description in FMI 2.0 (section 2.2).

use std::fmt::Write;

use super::{Description, Variable, escaped};

/// The description in FMI 2.0.
pub(super) fn xml(unit: &Description<'_>) -> String {
    let variables = unit.variables();
    let mut lists = String::new();
    for (reference, variable) in variables.iter().enumerate() {
        let Variable { name, description, is_input, unit: measured_in } = variable;
        let (attributes, start) = if *is_input {
            ("causality=\"input\" variability=\"continuous\"", " start=\"0\"")
        } else {
            ("causality=\"output\" variability=\"continuous\" initial=\"calculated\"", "")
        };
        // Writing to a text cannot fail.
        let _ = writeln!(
            lists,
            "    <ScalarVariable name=\"{}\" valueReference=\"{reference}\" description=\"{}\" {attributes}>\n      \
             <Real unit=\"{measured_in}\"{start}/>\n    </ScalarVariable>",
            escaped(name),
            escaped(description)
        );
    }
    let outputs: String =
        (unit.zones.len() + 1..=variables.len()).map(|index| format!("      <Unknown index=\"{index}\"/>\n")).collect();
    let (title, identifier, guid, summary) = (escaped(unit.title), unit.identifier, unit.guid, unit.summary());
    let (step_s, stop_s, version) = (unit.step_s, unit.stop_s, env!("CARGO_PKG_VERSION"));
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{title}" guid="{guid}" generationTool="Interplay {version}"
    variableNamingConvention="flat" numberOfEventIndicators="0"
    description="{summary}">
  <CoSimulation modelIdentifier="{identifier}" canHandleVariableCommunicationStepSize="false"
      canInterpolateInputs="false" canBeInstantiatedOnlyOncePerProcess="false"
      canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="true" canSerializeFMUstate="true"
      providesDirectionalDerivative="false"/>
  <UnitDefinitions>
    <Unit name="kW"><BaseUnit kg="1" m="2" s="-3" factor="1000"/></Unit>
    <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError" description="Errors"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="{stop_s}" stepSize="{step_s}"/>
  <ModelVariables>
{lists}  </ModelVariables>
  <ModelStructure>
    <Outputs>
{outputs}    </Outputs>
    <InitialUnknowns>
{outputs}    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"#
    )
}
