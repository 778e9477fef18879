//! Where silhouettes are found.

use serde::{Deserialize, Serialize};

/// What finds silhouettes and builds the indices of volumes. The pixels are the same.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// The processor, on all cores.
    #[default]
    Cpu,
    /// A compute shader; the counts go straight into indirect draws.
    Compute,
}

impl Backend {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::Cpu, Self::Compute];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Compute => "compute",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Cpu => "found by the processor on all its cores, and kept while neither caster nor light moves",
            Self::Compute => "found on the device, whose counts go into indirect draws: nothing is read back",
        }
    }

    /// The default.
    #[must_use]
    pub const fn is_cpu(&self) -> bool {
        matches!(self, Self::Cpu)
    }
}
