//! What the device can and cannot do, in plain data, so that planning needs no GPU.

use serde::Serialize;

/// The device, as far as a plan depends on it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Capabilities {
    /// The adapter's name and backend.
    pub adapter: String,
    /// Triangles before the near plane can be kept (`DEPTH_CLIP_CONTROL`).
    pub depth_clip_control: bool,
    /// GPU time can be measured (`TIMESTAMP_QUERY`).
    pub timestamps: bool,
    /// Four samples a pixel can be drawn and resolved in every format needed.
    pub four_samples: bool,
    /// Depth can be kept in floats (`DEPTH32FLOAT_STENCIL8`).
    pub float_depth: bool,
    /// What counts beyond the stencil are added up in.
    pub wide_counts: WideCounts,
    /// Four samples a pixel can be counted so, each by itself.
    pub wide_four_samples: bool,
    /// Silhouettes can be found by a compute shader (compute, indirect draws, `INDIRECT_FIRST_INSTANCE`), whose buffers
    /// hold so many bytes at most.
    pub compute_silhouettes: Option<u64>,
    /// Pixels a side.
    pub max_size: u32,
}

/// The format that wide counts are added up in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WideCounts {
    /// R32Float (`FLOAT32_BLENDABLE`).
    Float32,
    /// R16Float, which every device can blend.
    Float16,
}

impl WideCounts {
    /// The largest sum of ones, in any order, that is exact.
    #[must_use]
    pub const fn largest(self) -> u32 {
        match self {
            Self::Float32 => 1 << 24,
            Self::Float16 => 1 << 11,
        }
    }

    /// As WebGPU calls it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float32 => "R32Float",
            Self::Float16 => "R16Float",
        }
    }
}

/// Something the device lacks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Lack {
    /// What is missing.
    pub feature: &'static str,
    /// What is done instead.
    pub instead: &'static str,
}

impl Capabilities {
    /// A device that can do everything: for planning without one.
    #[must_use]
    pub fn complete() -> Self {
        Self {
            adapter: "none".into(),
            depth_clip_control: true,
            timestamps: true,
            four_samples: true,
            float_depth: true,
            wide_counts: WideCounts::Float32,
            wide_four_samples: true,
            compute_silhouettes: Some(128 << 20),
            max_size: 8192,
        }
    }

    /// What is missing, and what replaces it.
    #[must_use]
    pub fn lacks(&self) -> Vec<Lack> {
        [
            (
                self.depth_clip_control,
                Lack { feature: "depth clamp (DEPTH_CLIP_CONTROL)", instead: "exact z-pass counts every caster by z-fail" },
            ),
            (self.timestamps, Lack { feature: "GPU timestamps (TIMESTAMP_QUERY)", instead: "only CPU time is shown" }),
            (
                self.float_depth,
                Lack {
                    feature: "float depth (DEPTH32FLOAT_STENCIL8)",
                    instead: "24 bits are used: single pixels a hair from a volume's face may be wrong",
                },
            ),
            (self.four_samples, Lack { feature: "4 samples a pixel", instead: "1 sample is used" }),
            (
                self.wide_counts == WideCounts::Float32,
                Lack {
                    feature: "blending of R32Float (FLOAT32_BLENDABLE)",
                    instead: "the wide count is R16Float, exact to 2048",
                },
            ),
        ]
        .into_iter()
        .filter_map(|(there, lack)| (!there).then_some(lack))
        .collect()
    }
}
