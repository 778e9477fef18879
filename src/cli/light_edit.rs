//! `--light-edit "K:on=false,position=1;2;3"`: one light's changes as a word, and back.

use glam::{DVec3, Vec3};

use super::{index, numbers};
use crate::settings::{LightEdit, SlideChoice};

/// Reads a word such as `1:on=false,range=8`.
pub(super) fn parse(text: &str) -> Result<(usize, LightEdit), String> {
    let (light, fields) = text.split_once(':').ok_or("expected K:WHAT=VALUE,... such as 0:on=false")?;
    let light = index(light).map_err(|_| format!("`{light}` is no light's index"))?;
    let mut edit = LightEdit::default();
    for field in fields.split(',').filter(|field| !field.is_empty()) {
        let (name, value) = field.split_once('=').ok_or_else(|| format!("`{field}` is not WHAT=VALUE"))?;
        let wrong = |expected: &str| format!("{name}: expected {expected}, not `{value}`");
        let truth = || value.parse().map_err(|_| wrong("true or false"));
        let number = || value.parse().map_err(|_| wrong("a number"));
        let three = "three numbers, such as 1;2;3";
        match name {
            "on" => edit.on = Some(truth()?),
            "shadows" => edit.shadows = Some(truth()?),
            "position" => edit.position = Some(DVec3::from(numbers::<f64, 3>(value, ';').ok_or_else(|| wrong(three))?)),
            "color" => edit.color = Some(Vec3::from(numbers::<f32, 3>(value, ';').ok_or_else(|| wrong(three))?)),
            "intensity" => edit.intensity = Some(number()?),
            "range" => edit.range = Some(number()?),
            "radius" => edit.radius = Some(number()?),
            "slide" => {
                let known = SlideChoice::ALL.into_iter().find(|slide| slide.name() == value);
                edit.slide = Some(known.ok_or_else(|| wrong(&SlideChoice::ALL.map(SlideChoice::name).join(", ")))?);
            }
            _ => return Err(format!("`{name}` is not one of on, shadows, position, color, intensity, range, radius, slide")),
        }
    }
    Ok((light, edit))
}

/// Writes what [`parse`] reads; numbers keep every bit.
pub(super) fn format(light: usize, edit: &LightEdit) -> String {
    let LightEdit { position, color, intensity, range, on, shadows, radius, slide } = edit;
    let mut fields = Vec::new();
    let mut field = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            fields.push(format!("{name}={value}"));
        }
    };
    field("on", on.map(|on| on.to_string()));
    field("shadows", shadows.map(|shadows| shadows.to_string()));
    field("position", position.map(|p| format!("{};{};{}", p.x, p.y, p.z)));
    field("color", color.map(|c| format!("{};{};{}", c.x, c.y, c.z)));
    field("intensity", intensity.map(|intensity| intensity.to_string()));
    field("range", range.map(|range| range.to_string()));
    field("radius", radius.map(|radius| radius.to_string()));
    field("slide", slide.map(|slide| slide.name().into()));
    format!("{light}:{}", fields.join(","))
}

/// Lays `edit` over `under`: what it says wins, what it leaves out stays.
pub(super) fn merge(under: &mut LightEdit, edit: &LightEdit) {
    let LightEdit { position, color, intensity, range, on, shadows, radius, slide } = edit;
    under.position = position.or(under.position);
    under.color = color.or(under.color);
    under.intensity = intensity.or(under.intensity);
    under.range = range.or(under.range);
    under.on = on.or(under.on);
    under.shadows = shadows.or(under.shadows);
    under.radius = radius.or(under.radius);
    under.slide = slide.or(under.slide);
}
