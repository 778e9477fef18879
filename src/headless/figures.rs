//! `obscura figures`: the papers' figures into a folder, and a page that shows them all.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::save::save_png;
use super::{HeadlessError, progress_bar};
use crate::cli::render_command;
use crate::director;
use crate::figures::{Figure, Paper};
use crate::gpu::{Context, Renderer, readback};
use crate::settings::Settings;

/// The page's file name.
pub const PAGE: &str = "index.html";

/// Draws these figures into the folder `out`, which is made where it is missing, each of `size` pixels, with a page that
/// says what is to be seen in each. Gives the pictures.
///
/// # Errors
/// The first thing that stands in the way.
pub fn figures(figures: &[&'static Figure], size: [u32; 2], out: &Path) -> Result<Vec<PathBuf>, HeadlessError> {
    std::fs::create_dir_all(out).map_err(|error| HeadlessError::Folder(out.into(), error))?;
    let context = Context::headless(None)?;
    let mut renderer = Renderer::new(&context, None)?;
    let progress = progress_bar(figures.len() as u64);
    let mut files = Vec::with_capacity(figures.len());
    for figure in figures {
        progress.set_message(figure.name);
        let settings = settings(figure, size);
        let scene = super::render::open(&settings)?;
        renderer.set_scene(&context, &scene)?;
        let (pose, plan) = director::stage(&settings, &scene, context.capabilities())?;
        let (_, picture) = readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
        let path = out.join(format!("{}.png", figure.name));
        save_png(&path, &picture, &render_command(&settings))?;
        files.push(path);
        progress.inc(1);
    }
    progress.finish_and_clear();
    let page = out.join(PAGE);
    std::fs::write(&page, html(figures, size)).map_err(|error| HeadlessError::Folder(page.clone(), error))?;
    Ok(files)
}

/// A figure at its best: four samples a pixel, where it is no exact values.
#[must_use]
pub fn settings(figure: &Figure, size: [u32; 2]) -> Settings {
    figure.settings(&Settings { size, samples: 4, ..Settings::default() })
}

/// The page: it stands by itself and needs nothing but the pictures beside it.
#[must_use]
pub fn html(figures: &[&'static Figure], size: [u32; 2]) -> String {
    let mut page = String::from(HEAD);
    let of = |paper: Paper| figures.iter().filter(move |figure| figure.paper == paper);
    let papers: Vec<_> = Paper::ALL.into_iter().filter(|paper| of(*paper).next().is_some()).collect();
    page.push_str("<nav>\n");
    for (number, paper) in papers.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(page, "<a href=\"#paper-{number}\">{}</a> {}<br>", escaped(paper.title()), of(*paper).count());
    }
    page.push_str("</nav>\n");
    for (number, paper) in papers.into_iter().enumerate() {
        let title = escaped(paper.title());
        let _ = writeln!(page, "<h2 id=\"paper-{number}\">{title}</h2>\n<div class=\"figures\">");
        for figure in of(paper) {
            let Figure { name, number, title, seen, instead, .. } = figure;
            let [width, height] = size;
            let _ = writeln!(
                page,
                "<figure id=\"{name}\">\n<a href=\"{name}.png\"><img src=\"{name}.png\" width=\"{width}\" height=\"{height}\" alt=\"{}\" loading=\"lazy\"></a>\n<figcaption>\n<b>{}</b> <span>{}</span>\n<p>{}</p>",
                escaped(title),
                escaped(number),
                escaped(title),
                escaped(seen)
            );
            if !instead.is_empty() {
                let _ = writeln!(page, "<p class=\"instead\">Here with {}.</p>", escaped(instead));
            }
            let command = render_command(&settings(figure, size));
            let _ = writeln!(page, "<code>{}</code>\n</figcaption>\n</figure>", words(&command));
        }
        page.push_str("</div>\n");
    }
    page.push_str("</body>\n</html>\n");
    page
}

/// What the page begins with.
const HEAD: &str = "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>Obscura: the papers' figures</title>
<style>
body { background: #14171c; color: #d9dbe0; font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 1400px; padding: clamp(12px, 3vw, 24px); }
h1, h2 { color: #f0b45a; font-weight: 600; line-height: 1.25; text-wrap: balance; }
h2 { border-top: 1px solid #2b303a; font-size: 1.15em; margin-top: 2em; padding-top: 1em; }
a { color: #9fc7e8; text-decoration: none; }
a:hover, a:focus-visible { text-decoration: underline; }
nav { color: #9aa0ab; }
.figures { display: grid; gap: clamp(16px, 3vw, 28px); grid-template-columns: repeat(auto-fill, minmax(min(420px, 100%), 1fr)); }
figure { background: #1c2028; border-radius: 8px; display: flex; flex-direction: column; margin: 0; overflow: hidden; }
figure:target { outline: 2px solid #f0b45a; }
figure img { display: block; height: auto; width: 100%; }
figcaption { padding: 12px 16px 16px; }
figcaption p { margin: 6px 0; }
figcaption b { color: #f0b45a; margin-right: 8px; }
.instead { color: #9aa0ab; font-size: 0.9em; font-style: italic; }
code { background: #14171c; border-radius: 4px; color: #9fc7e8; display: block; font-size: 0.8em; margin-top: 8px; min-width: 0; padding: 8px; user-select: all; }
code span { display: inline-block; max-width: 100%; overflow-wrap: anywhere; vertical-align: top; }
</style>
</head>
<body>
<h1>Obscura: the papers' figures</h1>
<p>Each picture is drawn by the command beneath it. The scenes are built from the papers' captions and text.</p>
";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A command, broken between its words alone: a dash at the end of a line would belong to the next.
fn words(command: &str) -> String {
    let words: Vec<_> = command.split(' ').map(|word| format!("<span>{}</span>", escaped(word))).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::TABLE;

    #[test]
    fn the_page_has_every_figure_with_the_command_that_draws_it() {
        let page = html(&TABLE, [640, 360]);
        let plain = page.replace("</span> <span>", " ").replace("<code><span>", "<code>").replace("</span></code>", "</code>");
        assert!(page.matches("<h2").count() > 2 && page.matches("href=\"#paper-").count() == page.matches("<h2").count());
        for figure in TABLE.iter() {
            assert!(page.contains(&format!("src=\"{}.png\"", figure.name)), "{}", figure.name);
            let command = render_command(&settings(figure, [640, 360]));
            assert!(plain.contains(&format!("<code>{}</code>", escaped(&command))), "{command}");
        }
        assert!(page.ends_with("</html>\n") && page.matches("<figure").count() == TABLE.len());
        assert_eq!(page.matches('<').count(), page.matches('>').count(), "every tag is closed");
    }

    #[test]
    fn what_html_would_read_is_escaped() {
        assert_eq!(escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
    }
}
