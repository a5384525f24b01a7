//! Thermal parameters from telemetry.
