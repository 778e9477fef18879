//! Buffers that are as large as a frame has needed so far.

use super::context::Context;

/// A device buffer that is made anew, larger, when its data outgrow it.
pub struct Growing {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl Growing {
    /// A buffer yet to be made.
    pub fn new(label: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self { label, usage: usage | wgpu::BufferUsages::COPY_DST, buffer: None }
    }

    /// Writes `bytes`; true where the buffer was made anew.
    pub fn write(&mut self, context: &Context, bytes: &[u8], least: usize) -> bool {
        let grown = self.reserve(context, bytes.len().max(least) as u64);
        if let Some(buffer) = &self.buffer {
            context.queue.write_buffer(buffer, 0, bytes);
        }
        grown
    }

    /// Makes room for so many bytes, what was in it lost where that takes another buffer; says whether it does.
    pub fn reserve(&mut self, context: &Context, bytes: u64) -> bool {
        let needed = bytes.next_multiple_of(16).max(16);
        let grown = self.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed);
        if grown {
            let limits = context.device.limits();
            let in_one_piece = self.usage.contains(wgpu::BufferUsages::STORAGE);
            let bound = if in_one_piece { limits.max_storage_buffer_binding_size } else { u64::MAX };
            let largest = limits.max_buffer_size.min(bound);
            self.buffer = Some(context.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.label),
                size: (needed + needed / 2 / 16 * 16).min(largest / 16 * 16).max(needed),
                usage: self.usage,
                mapped_at_creation: false,
            }));
        }
        grown
    }

    /// Writes into what there is room for.
    pub fn write_at(&self, context: &Context, offset: u64, bytes: &[u8]) {
        if let Some(buffer) = self.buffer.as_ref().filter(|_| !bytes.is_empty()) {
            context.queue.write_buffer(buffer, offset, bytes);
        }
    }

    /// The buffer, once something was written.
    #[must_use]
    pub fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }
}
