//! GPU times of one frame in flight.

use ash::vk;

use super::allocator::MemoryUse;
use super::barriers::Barriers;
use super::memory::{Backed, Memory};
use super::{Host, failed, requirements};
use crate::Result;

/// Timestamp queries of one frame in flight, and the buffer that their results are copied to. The host neither resets nor
/// reads queries, so `hostQueryReset` is not needed.
pub(in crate::gpu) struct Timestamps {
    queries: vk::QueryPool,
    /// Ticks of each query, and after them a word that is not 0 once all are there.
    copied: Backed,
    /// The number of queries.
    count: usize,
    tick_ns: f64,
    /// The valid bits of ticks.
    mask: u64,
}

/// A barrier from copies and fills of the buffer to what uses it next.
fn copied_before(
    stage: vk::PipelineStageFlags2,
    access: vk::AccessFlags2,
) -> [vk::MemoryBarrier2<'static>; 1] {
    [vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(stage)
        .dst_access_mask(access)]
}

impl Timestamps {
    /// For that many timestamps; none where the host's queue family has no timestamps.
    pub(in crate::gpu) fn new(
        host: &Host,
        memory: &mut Memory,
        name: &str,
        count: usize,
    ) -> Result<Option<Self>> {
        let Some((tick_ns, bits)) = requirements::timestamps(host) else { return Ok(None) };
        let mask = u64::MAX >> (64 - bits.min(64));
        let bytes = (count as u64 + 1) * 8;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let copied = memory.buffer("timestamps", bytes, usage, MemoryUse::Readback)?;
        let queries = vk::QueryPool::null();
        let mut timestamps = Self { queries, copied, count, tick_ns, mask };
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(count as u32);
        // SAFETY: the device is alive.
        match unsafe { host.device.create_query_pool(&info, None) } {
            Ok(queries) => {
                timestamps.queries = queries;
                host.name(queries, name);
                Ok(Some(timestamps))
            }
            Err(result) => {
                timestamps.free(host, memory);
                Err(failed("making a frame's timestamps")(result))
            }
        }
    }

    /// Records that `count` timestamps follow. Until they have been copied, [`ns`](Self::ns) returns none.
    ///
    /// # Safety
    /// `commands` is being recorded outside a render pass; the last recording with these timestamps has run.
    pub(in crate::gpu) unsafe fn begin(
        &mut self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        count: usize,
    ) {
        self.copied.mapped().fill(0);
        // In the command buffer too, in case it runs again.
        let buffer = self.copied.buffer;
        let last_run =
            copied_before(vk::PipelineStageFlags2::ALL_TRANSFER, vk::AccessFlags2::TRANSFER_WRITE);
        // SAFETY: as the caller guarantees; the pool has at least that many queries, and the buffer one word more.
        unsafe {
            Barriers::default().memory(&last_run).record(device, commands);
            device.cmd_fill_buffer(commands, buffer, self.count as u64 * 8, 8, 0);
            device.cmd_reset_query_pool(commands, self.queries, 0, count as u32);
        }
    }

    /// Records one timestamp, after earlier commands have finished this stage.
    ///
    /// # Safety
    /// `commands` is being recorded for the host's family, after [`begin`](Self::begin).
    pub(in crate::gpu) unsafe fn write(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        stage: vk::PipelineStageFlags,
        index: usize,
    ) {
        // SAFETY: as the caller guarantees; the query has been reset.
        unsafe { device.cmd_write_timestamp(commands, stage, self.queries, index as u32) };
    }

    /// Records the copy of all `count` timestamps to the host.
    ///
    /// # Safety
    /// As [`begin`](Self::begin), after all of them have been written.
    pub(in crate::gpu) unsafe fn end(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        count: usize,
    ) {
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        let buffer = self.copied.buffer;
        let before_flag =
            copied_before(vk::PipelineStageFlags2::ALL_TRANSFER, vk::AccessFlags2::TRANSFER_WRITE);
        let to_host = copied_before(vk::PipelineStageFlags2::HOST, vk::AccessFlags2::HOST_READ);
        let flag = self.count as u64 * 8;
        // SAFETY: as the caller guarantees; the buffer holds a word for each query, and the last one.
        unsafe {
            device.cmd_copy_query_pool_results(
                commands,
                self.queries,
                0,
                count as u32,
                buffer,
                0,
                8,
                flags,
            );
            Barriers::default().memory(&before_flag).record(device, commands);
            device.cmd_fill_buffer(commands, buffer, flag, 8, 1);
            Barriers::default().memory(&to_host).record(device, commands);
        }
    }

    /// Nanoseconds between each timestamp and the next, of `count`. None until all have been copied.
    pub(in crate::gpu) fn ns(&self, count: usize) -> Option<Vec<f64>> {
        self.copied.word(self.count).filter(|flag| *flag != 0)?;
        let ticks: Option<Vec<u64>> = (0..count).map(|query| self.copied.word(query)).collect();
        let ns = |pair: &[u64]| (pair[1].wrapping_sub(pair[0]) & self.mask) as f64 * self.tick_ns;
        Some(ticks?.windows(2).map(ns).collect())
    }

    /// Destroys them. The device must be done with them.
    pub(in crate::gpu) fn free(mut self, host: &Host, memory: &mut Memory) {
        // SAFETY: made by this device; the caller guarantees that nothing in flight uses it. Null is allowed.
        unsafe { host.device.destroy_query_pool(self.queries, None) };
        memory.free(&mut self.copied);
    }
}
