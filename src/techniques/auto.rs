//! Auto: each caster by the cheapest form that is exact for it (M section 6; DESIGN section 4).
//!
//! ```text
//!   its shadow meets nothing lit and in view   dropped
//!   it throws no shadow on the near plane      z-pass: sides, from the near plane          (M's case 1)
//!   it may, but how often it holds the eye     exact z-pass: sides, from the eye           (cases 2, 3)
//!     is known
//!   all else                                   z-fail: sides and the caps that are in view (cases 2, 3)
//! ```
//!
//! M takes z-fail for all of cases 2 and 3. The step between is ours: where the eye's own count can
//! be told ([`super::exact_z_pass`]), sides will do there too.
//!
//! Z-pass is exact in case 1 because no point from the eye to the near rectangle is in this caster's
//! shadow: the count starts at zero, and no face between eye and surface is cut away. As for every
//! count from the eye, the caster's own surface must surely be in the depth buffer, or a ray could
//! enter the volume by the light cap unseen. Counts add, so the forms mix freely.

use super::{Caster, Row, exact_z_pass, z_fail, z_pass};
use crate::frame::plan::Case;
use crate::frame::{Method, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::Auto,
    title: "Auto",
    about: "Each caster by the cheapest form that is exact for it: z-pass, exact z-pass or z-fail.",
    exact: true,
    source: "McGuire et al. 2003, 6 and 7; Lengyel 2002, Determining Whether Caps are Necessary",
    decide: |caster| Some(decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[z_pass::GROUPS, exact_z_pass::GROUPS, z_fail::GROUPS],
};

fn decide(caster: &Caster<'_>) -> (Method, Reason) {
    if caster.sight.case == Some(Case::One) && caster.surface_covers() {
        (Method::ZPass, Reason::NearPlaneClear)
    } else {
        exact_z_pass::decide(caster)
    }
}
