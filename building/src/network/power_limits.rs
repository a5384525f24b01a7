//! Limits on the heating and cooling power of each zone.

/// The largest heating and cooling power of each zone.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerLimits {
    /// Largest heating power of each zone, at least 0 \[kW\].
    pub heating_kw: Vec<f64>,
    /// Largest cooling power of each zone, at least 0 \[kW\].
    pub cooling_kw: Vec<f64>,
}

impl PowerLimits {
    /// Limits of equipment that cools as strongly as it heats; one number per zone \[kW\].
    pub fn symmetric(limits_kw: &[f64]) -> Self {
        Self { heating_kw: limits_kw.to_vec(), cooling_kw: limits_kw.to_vec() }
    }

    /// Number of zones.
    pub fn zones(&self) -> usize {
        self.heating_kw.len()
    }

    /// The heat that a zone gets if `heat_kw` is requested; negative is cooling \[kW\].
    ///
    /// # Panics
    /// When `zone` is out of range.
    pub fn limited(&self, zone: usize, heat_kw: f64) -> f64 {
        heat_kw.clamp(-self.cooling_kw[zone], self.heating_kw[zone])
    }

    /// The heat that every zone gets if `heat_kw` is requested, one number per zone \[kW\].
    pub(crate) fn limited_all(&self, heat_kw: &[f64]) -> Vec<f64> {
        heat_kw.iter().enumerate().map(|(zone, kw)| self.limited(zone, *kw)).collect()
    }

    /// The limit on the side of `heat_kw`: that of cooling where it is negative \[kW\].
    ///
    /// # Panics
    /// When `zone` is out of range.
    pub(crate) fn towards_kw(&self, zone: usize, heat_kw: f64) -> f64 {
        if heat_kw < 0.0 { self.cooling_kw[zone] } else { self.heating_kw[zone] }
    }

    /// Amount by which a request exceeds its limit; negative within it \[kW\].
    pub fn excess_kw(&self, zone: usize, heat_kw: f64) -> f64 {
        heat_kw.abs() - self.towards_kw(zone, heat_kw)
    }
}
