//! A board as the calls that would draw it, in the words of four interfaces, ready to copy.
//!
//! Each says the same: clear, and then for each shape its depth and stencil state. Where the two faces differ in
//! reference or masks, wgpu takes two pipelines and two draws, Direct3D 12 a newer description with the masks of each
//! face, Vulkan nothing new, and OpenGL the calls with `Separate` in their names.

use std::fmt::Write as _;

use super::needs_two_draws;
use crate::frame::state::Compare;
use crate::frame::stencil::StencilOp;
use crate::settings::{Api, Board, Face, Shape};

/// The whole board in the words of `api`.
#[must_use]
pub fn calls(board: &Board, api: Api) -> String {
    let mut text = clear(board, api);
    for (number, shape) in (1..).zip(&board.shapes) {
        // A line of its own, whatever a name holds.
        let title = shape.title().replace(char::is_control, " ");
        let _ = write!(text, "\n// {number} {title}\n{}", state(shape, api));
    }
    text
}

fn clear(board: &Board, api: Api) -> String {
    let Board { clear, clear_depth, .. } = board;
    match api {
        Api::Wgpu => format!(
            "// In the render pass's depth_stencil_attachment:\n\
             depth_ops: Some(wgpu::Operations {{ load: wgpu::LoadOp::Clear({clear_depth:?}), store: wgpu::StoreOp::Store }}),\n\
             stencil_ops: Some(wgpu::Operations {{ load: wgpu::LoadOp::Clear({clear:#04x}), store: wgpu::StoreOp::Store }}),\n"
        ),
        Api::Vulkan => format!(
            "// In the depth and stencil attachment: loadOp and stencilLoadOp are VK_ATTACHMENT_LOAD_OP_CLEAR.\n\
             VkClearValue clearValue = {{ .depthStencil = {{ .depth = {clear_depth:?}f, .stencil = {clear:#04x} }} }};\n"
        ),
        Api::D3d12 => format!(
            "commandList->ClearDepthStencilView(dsv, D3D12_CLEAR_FLAG_DEPTH | D3D12_CLEAR_FLAG_STENCIL, {clear_depth:?}f, {clear:#04x}, 0, nullptr);\n"
        ),
        // The clear obeys the masks, K warns.
        Api::OpenGl => format!(
            "glDepthMask(GL_TRUE);\nglStencilMask(0xff); // a clear obeys the masks\n\
             glClearDepth({clear_depth:?});\nglClearStencil({clear:#04x});\nglClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);\n\
             glEnable(GL_DEPTH_TEST);\nglEnable(GL_STENCIL_TEST);\nglFrontFace(GL_CCW);\n"
        ),
    }
}

fn state(shape: &Shape, api: Api) -> String {
    match api {
        Api::Wgpu => wgpu_state(shape),
        Api::Vulkan => vulkan_state(shape),
        Api::D3d12 => d3d12_state(shape),
        Api::OpenGl => opengl_state(shape),
    }
}

fn wgpu_state(shape: &Shape) -> String {
    if needs_two_draws(shape) {
        let front = wgpu_pass(shape, (shape.front, shape.front), "Some(wgpu::Face::Back)");
        let back = wgpu_pass(shape, (shape.back(), shape.back()), "Some(wgpu::Face::Front)");
        return format!(
            "// wgpu has one reference and one pair of masks for both faces: two pipelines, two draws.\n// Front faces:\n{front}// Back faces:\n{back}"
        );
    }
    wgpu_pass(shape, (shape.front, shape.back()), "None")
}

fn wgpu_pass(shape: &Shape, (front, back): (Face, Face), cull_mode: &str) -> String {
    let face = |face: Face| {
        format!(
            "wgpu::StencilFaceState {{ compare: wgpu::CompareFunction::{:?}, fail_op: wgpu::StencilOperation::{:?}, \
             depth_fail_op: wgpu::StencilOperation::{:?}, pass_op: wgpu::StencilOperation::{:?} }}",
            face.compare, face.fail, face.depth_fail, face.pass
        )
    };
    format!(
        "depth_stencil: Some(wgpu::DepthStencilState {{\n    \
             format: wgpu::TextureFormat::Depth24PlusStencil8,\n    \
             depth_write_enabled: Some({}),\n    \
             depth_compare: Some(wgpu::CompareFunction::{:?}),\n    \
             stencil: wgpu::StencilState {{\n        \
                 front: {},\n        \
                 back: {},\n        \
                 read_mask: {:#04x},\n        \
                 write_mask: {:#04x},\n    \
             }},\n    \
             bias: wgpu::DepthBiasState::default(),\n\
         }}),\n\
         primitive: wgpu::PrimitiveState {{ front_face: wgpu::FrontFace::Ccw, cull_mode: {cull_mode}, ..Default::default() }},\n\
         pass.set_stencil_reference({:#04x});\n",
        shape.depth_write,
        shape.depth_compare,
        face(front),
        face(back),
        front.read_mask,
        front.write_mask,
        front.reference,
    )
}

fn vulkan_state(shape: &Shape) -> String {
    let face = |face: Face| {
        format!(
            "{{ .failOp = VK_STENCIL_OP_{}, .passOp = VK_STENCIL_OP_{}, .depthFailOp = VK_STENCIL_OP_{},\n               \
             .compareOp = VK_COMPARE_OP_{}, .compareMask = {:#04x}, .writeMask = {:#04x}, .reference = {:#04x} }}",
            vulkan_op(face.fail),
            vulkan_op(face.pass),
            vulkan_op(face.depth_fail),
            vulkan_compare(face.compare),
            face.read_mask,
            face.write_mask,
            face.reference
        )
    };
    let truth = if shape.depth_write { "VK_TRUE" } else { "VK_FALSE" };
    format!(
        "VkPipelineDepthStencilStateCreateInfo depthStencil = {{\n    \
             .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,\n    \
             .depthTestEnable = VK_TRUE,\n    \
             .depthWriteEnable = {truth},\n    \
             .depthCompareOp = VK_COMPARE_OP_{},\n    \
             .stencilTestEnable = VK_TRUE,\n    \
             .front = {},\n    \
             .back = {},\n\
         }};\n",
        vulkan_compare(shape.depth_compare),
        face(shape.front),
        face(shape.back()),
    )
}

fn d3d12_state(shape: &Shape) -> String {
    let two = needs_two_draws(shape);
    let (front, back) = (shape.front, shape.back());
    let face = |name: &str, face: Face| {
        let ops = format!(
            "D3D12_STENCIL_OP_{}, D3D12_STENCIL_OP_{}, D3D12_STENCIL_OP_{}, D3D12_COMPARISON_FUNC_{}",
            d3d12_op(face.fail),
            d3d12_op(face.depth_fail),
            d3d12_op(face.pass),
            d3d12_compare(face.compare)
        );
        let masks = if two { format!(", {:#04x}, {:#04x}", face.read_mask, face.write_mask) } else { String::new() };
        let order = if two { "fail, depth fail, pass, func, read mask, write mask" } else { "fail, depth fail, pass, func" };
        format!("depthStencil.{name} = {{ {ops}{masks} }}; // {order}\n")
    };
    let mut text = if two {
        "// Masks and references of each face: OPTIONS14.IndependentFrontAndBackStencilRefMaskSupported.\n\
         D3D12_DEPTH_STENCIL_DESC2 depthStencil = {};\n"
            .to_owned()
    } else {
        "D3D12_DEPTH_STENCIL_DESC depthStencil = {};\n".to_owned()
    };
    let mask = if shape.depth_write { "ALL" } else { "ZERO" };
    let _ = write!(
        text,
        "depthStencil.DepthEnable = TRUE;\n\
         depthStencil.DepthWriteMask = D3D12_DEPTH_WRITE_MASK_{mask};\n\
         depthStencil.DepthFunc = D3D12_COMPARISON_FUNC_{};\n\
         depthStencil.StencilEnable = TRUE;\n",
        d3d12_compare(shape.depth_compare)
    );
    if !two {
        let Face { read_mask, write_mask, .. } = front;
        let _ = write!(
            text,
            "depthStencil.StencilReadMask = {read_mask:#04x};\ndepthStencil.StencilWriteMask = {write_mask:#04x};\n"
        );
    }
    text.push_str(&face("FrontFace", front));
    text.push_str(&face("BackFace", back));
    text.push_str("rasterizer.FrontCounterClockwise = TRUE;\n");
    let _ = if two {
        writeln!(text, "commandList8->OMSetFrontAndBackStencilRef({:#04x}, {:#04x});", front.reference, back.reference)
    } else {
        writeln!(text, "commandList->OMSetStencilRef({:#04x});", front.reference)
    };
    text
}

fn opengl_state(shape: &Shape) -> String {
    let mask = if shape.depth_write { "TRUE" } else { "FALSE" };
    let mut text = format!("glDepthFunc(GL_{});\nglDepthMask(GL_{mask});\n", opengl_compare(shape.depth_compare));
    let mut face = |suffix: &str, which: &str, face: Face| {
        let _ = write!(
            text,
            "glStencilFunc{suffix}({which}GL_{}, {:#04x}, {:#04x});\nglStencilOp{suffix}({which}GL_{}, GL_{}, GL_{}); // fail, depth fail, pass\n\
             glStencilMask{suffix}({which}{:#04x});\n",
            opengl_compare(face.compare),
            face.reference,
            face.read_mask,
            opengl_op(face.fail),
            opengl_op(face.depth_fail),
            opengl_op(face.pass),
            face.write_mask
        );
    };
    if shape.front == shape.back() {
        face("", "", shape.front);
    } else {
        face("Separate", "GL_FRONT, ", shape.front);
        face("Separate", "GL_BACK, ", shape.back());
    }
    text
}

const fn vulkan_op(op: StencilOp) -> &'static str {
    match op {
        StencilOp::Keep => "KEEP",
        StencilOp::Zero => "ZERO",
        StencilOp::Replace => "REPLACE",
        StencilOp::Invert => "INVERT",
        StencilOp::IncrementClamp => "INCREMENT_AND_CLAMP",
        StencilOp::DecrementClamp => "DECREMENT_AND_CLAMP",
        StencilOp::IncrementWrap => "INCREMENT_AND_WRAP",
        StencilOp::DecrementWrap => "DECREMENT_AND_WRAP",
    }
}

const fn d3d12_op(op: StencilOp) -> &'static str {
    match op {
        StencilOp::IncrementClamp => "INCR_SAT",
        StencilOp::DecrementClamp => "DECR_SAT",
        StencilOp::IncrementWrap => "INCR",
        StencilOp::DecrementWrap => "DECR",
        StencilOp::Keep | StencilOp::Zero | StencilOp::Replace | StencilOp::Invert => vulkan_op(op),
    }
}

const fn opengl_op(op: StencilOp) -> &'static str {
    match op {
        StencilOp::IncrementClamp => "INCR",
        StencilOp::DecrementClamp => "DECR",
        StencilOp::IncrementWrap => "INCR_WRAP",
        StencilOp::DecrementWrap => "DECR_WRAP",
        StencilOp::Keep | StencilOp::Zero | StencilOp::Replace | StencilOp::Invert => vulkan_op(op),
    }
}

const fn d3d12_compare(compare: Compare) -> &'static str {
    match compare {
        Compare::Never => "NEVER",
        Compare::Always => "ALWAYS",
        Compare::Equal => "EQUAL",
        Compare::NotEqual => "NOT_EQUAL",
        Compare::Less => "LESS",
        Compare::LessEqual => "LESS_EQUAL",
        Compare::Greater => "GREATER",
        Compare::GreaterEqual => "GREATER_EQUAL",
    }
}

const fn vulkan_compare(compare: Compare) -> &'static str {
    match compare {
        Compare::LessEqual => "LESS_OR_EQUAL",
        Compare::GreaterEqual => "GREATER_OR_EQUAL",
        _ => d3d12_compare(compare),
    }
}

const fn opengl_compare(compare: Compare) -> &'static str {
    match compare {
        Compare::NotEqual => "NOTEQUAL",
        Compare::LessEqual => "LEQUAL",
        Compare::GreaterEqual => "GEQUAL",
        _ => d3d12_compare(compare),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(shape: Shape, api: Api) -> String {
        calls(&Board { clear: 0x2a, clear_depth: 1.0, shapes: vec![shape] }, api)
    }

    #[test]
    fn each_interface_says_all_of_the_state() {
        let front = Face {
            compare: Compare::LessEqual,
            reference: 0x11,
            read_mask: 0x3c,
            write_mask: 0xf7,
            fail: StencilOp::DecrementWrap,
            depth_fail: StencilOp::IncrementClamp,
            pass: StencilOp::Replace,
        };
        let shape = Shape { front, depth_compare: Compare::NotEqual, depth_write: true, ..Shape::default() };
        let expected: [(Api, &[&str]); 4] = [
            (
                Api::Wgpu,
                &[
                    "LoadOp::Clear(0x2a)",
                    "compare: wgpu::CompareFunction::LessEqual",
                    "fail_op: wgpu::StencilOperation::DecrementWrap, depth_fail_op: wgpu::StencilOperation::IncrementClamp, pass_op: wgpu::StencilOperation::Replace",
                    "depth_compare: Some(wgpu::CompareFunction::NotEqual)",
                    "depth_write_enabled: Some(true)",
                    "read_mask: 0x3c",
                    "write_mask: 0xf7",
                    "set_stencil_reference(0x11)",
                    "cull_mode: None",
                ],
            ),
            (
                Api::Vulkan,
                &[
                    ".stencil = 0x2a",
                    ".failOp = VK_STENCIL_OP_DECREMENT_AND_WRAP, .passOp = VK_STENCIL_OP_REPLACE, .depthFailOp = VK_STENCIL_OP_INCREMENT_AND_CLAMP",
                    ".compareOp = VK_COMPARE_OP_LESS_OR_EQUAL, .compareMask = 0x3c, .writeMask = 0xf7, .reference = 0x11",
                    ".depthCompareOp = VK_COMPARE_OP_NOT_EQUAL",
                    ".depthWriteEnable = VK_TRUE",
                ],
            ),
            (
                Api::D3d12,
                &[
                    "1.0f, 0x2a",
                    "D3D12_STENCIL_OP_DECR, D3D12_STENCIL_OP_INCR_SAT, D3D12_STENCIL_OP_REPLACE, D3D12_COMPARISON_FUNC_LESS_EQUAL",
                    "StencilReadMask = 0x3c",
                    "StencilWriteMask = 0xf7",
                    "OMSetStencilRef(0x11)",
                    "DepthFunc = D3D12_COMPARISON_FUNC_NOT_EQUAL",
                    "DEPTH_WRITE_MASK_ALL",
                ],
            ),
            (
                Api::OpenGl,
                &[
                    "glClearStencil(0x2a)",
                    "glStencilFunc(GL_LEQUAL, 0x11, 0x3c)",
                    "glStencilOp(GL_DECR_WRAP, GL_INCR, GL_REPLACE)",
                    "glStencilMask(0xf7)",
                    "glDepthFunc(GL_NOTEQUAL)",
                    "glDepthMask(GL_TRUE)",
                ],
            ),
        ];
        for (api, parts) in expected {
            let text = of(shape.clone(), api);
            for part in parts {
                assert!(text.contains(part), "{api:?} lacks {part}:\n{text}");
            }
        }
    }

    #[test]
    fn faces_that_differ_are_told_apart() {
        let back = Some(Face { reference: 7, pass: StencilOp::Invert, ..Face::default() });
        let shape = Shape { back, ..Shape::default() };
        let gl = of(shape.clone(), Api::OpenGl);
        assert!(
            gl.contains("glStencilFuncSeparate(GL_BACK, GL_ALWAYS, 0x07") && gl.contains("GL_FRONT, GL_ALWAYS, 0x00"),
            "{gl}"
        );
        assert!(of(shape.clone(), Api::D3d12).contains("OMSetFrontAndBackStencilRef(0x00, 0x07)"));
        let two = of(shape.clone(), Api::Wgpu);
        assert!(
            two.contains("Face::Back") && two.contains("Face::Front") && two.contains("set_stencil_reference(0x07)"),
            "{two}"
        );
        let alike = Shape { back: Some(Face { pass: StencilOp::Invert, ..Face::default() }), ..shape };
        assert!(!of(alike, Api::Wgpu).contains("two draws"), "ops may differ in one");
    }

    #[test]
    fn wgpu_has_these_names() {
        let compares: [wgpu::CompareFunction; 8] = [
            wgpu::CompareFunction::Never,
            wgpu::CompareFunction::Less,
            wgpu::CompareFunction::LessEqual,
            wgpu::CompareFunction::Equal,
            wgpu::CompareFunction::GreaterEqual,
            wgpu::CompareFunction::Greater,
            wgpu::CompareFunction::NotEqual,
            wgpu::CompareFunction::Always,
        ];
        for (ours, theirs) in Compare::ALL.into_iter().zip(compares) {
            assert_eq!(format!("{ours:?}"), format!("{theirs:?}"));
        }
        let ops: [wgpu::StencilOperation; 8] = [
            wgpu::StencilOperation::Keep,
            wgpu::StencilOperation::Zero,
            wgpu::StencilOperation::Replace,
            wgpu::StencilOperation::Invert,
            wgpu::StencilOperation::IncrementClamp,
            wgpu::StencilOperation::DecrementClamp,
            wgpu::StencilOperation::IncrementWrap,
            wgpu::StencilOperation::DecrementWrap,
        ];
        for (ours, theirs) in StencilOp::ALL.into_iter().zip(ops) {
            assert_eq!(format!("{ours:?}"), format!("{theirs:?}"));
        }
    }
}
