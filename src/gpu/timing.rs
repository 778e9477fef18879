//! GPU time of a frame by timestamp queries, read back without waiting, a few frames late.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::context::Context;

const BYTES: u64 = 16;

/// Two timestamps a frame, and the buffers they come back in.
pub struct Timing {
    queries: Option<wgpu::QuerySet>,
    resolve: Option<wgpu::Buffer>,
    period_ns: f64,
    slots: Vec<Slot>,
    latest: Option<f64>,
}

struct Slot {
    buffer: wgpu::Buffer,
    busy: bool,
    ready: Arc<AtomicBool>,
}

impl Timing {
    /// Queries, where the device has them.
    #[must_use]
    pub fn new(context: &Context) -> Self {
        let there = context.capabilities().timestamps;
        let device = &context.device;
        let queries = there.then(|| {
            device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("frame time"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            })
        });
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size: BYTES, usage, mapped_at_creation: false })
        };
        let resolve = there.then(|| buffer("frame time", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC));
        let slots = (0..if there { 4 } else { 0 })
            .map(|_| Slot {
                buffer: buffer("frame time, read back", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
                busy: false,
                ready: Arc::default(),
            })
            .collect();
        Self { queries, resolve, period_ns: f64::from(context.queue.get_timestamp_period()), slots, latest: None }
    }

    /// What a render pass writes: the start in the first, the end in the last.
    #[must_use]
    pub fn writes(&self, first: bool, last: bool) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let query_set = self.queries.as_ref().filter(|_| first || last)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: first.then_some(0),
            end_of_pass_write_index: last.then_some(1),
        })
    }

    /// What a compute pass before all of them writes: the start.
    #[must_use]
    pub fn begins(&self) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        Some(wgpu::ComputePassTimestampWrites {
            query_set: self.queries.as_ref()?,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: None,
        })
    }

    /// Records the copy of this frame's timestamps; the slot to [`read`](Self::read) after submitting.
    pub fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) -> Option<usize> {
        let (queries, resolve) = (self.queries.as_ref()?, self.resolve.as_ref()?);
        let slot = self.slots.iter().position(|slot| !slot.busy)?;
        encoder.resolve_query_set(queries, 0..2, resolve, 0);
        encoder.copy_buffer_to_buffer(resolve, 0, &self.slots[slot].buffer, 0, BYTES);
        Some(slot)
    }

    /// Asks for a slot's data once the frame is submitted.
    pub fn read(&mut self, slot: Option<usize>) {
        if let Some(slot) = slot.and_then(|slot| self.slots.get_mut(slot)) {
            slot.busy = true;
            slot.ready.store(false, Ordering::Release);
            let ready = slot.ready.clone();
            slot.buffer.map_async(wgpu::MapMode::Read, .., move |result| {
                if result.is_ok() {
                    ready.store(true, Ordering::Release);
                }
            });
        }
    }

    /// The newest frame time that has arrived, milliseconds.
    pub fn latest(&mut self) -> Option<f64> {
        for slot in &mut self.slots {
            if slot.busy && slot.ready.load(Ordering::Acquire) {
                if let Ok(view) = slot.buffer.get_mapped_range(..)
                    && let [start, end] = *bytemuck::cast_slice::<u8, u64>(&view)
                    && start != 0
                    && end >= start
                {
                    #[expect(clippy::cast_precision_loss, reason = "a frame is far shorter than 2^53 ticks")]
                    let ticks = (end - start) as f64;
                    self.latest = Some(ticks * self.period_ns / 1e6);
                }
                slot.buffer.unmap();
                slot.busy = false;
            }
        }
        self.latest
    }
}
