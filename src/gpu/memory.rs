mod attachment;

use ash::vk;

use super::allocator::{Allocation, Allocator, MemoryRequest, MemoryUse};
use super::{Host, failed};
use crate::graph::{Format, Kind};
use crate::{Error, Result};

pub(crate) use attachment::{DEPTH, whole_attachment};

/// An image or a buffer with its memory.
#[doc(hidden)]
#[derive(Default)]
pub struct Backed {
    /// Null for a buffer.
    pub image: vk::Image,
    /// Null for a buffer.
    pub view: vk::ImageView,
    /// Null for an image.
    pub buffer: vk::Buffer,
    pub(crate) texels: vk::BufferView,
    allocation: Option<Allocation>,
    /// Bytes of the buffer.
    bytes: u64,
    pub(crate) layers: u32,
}

impl Backed {
    /// The bytes of a buffer that was not made for the device alone: its making refuses memory that is not mapped.
    pub fn mapped(&mut self) -> &mut [u8] {
        let begin = self.allocation.as_ref().and_then(|allocation| allocation.mapped);
        let begin = begin.expect("host-visible memory is mapped");
        // SAFETY: the allocator guarantees that it is mapped while allocated, at least as large as the buffer,
        // and owned by nobody else. The caller guarantees that the device is not using it, as with any mapped
        // memory.
        unsafe { std::slice::from_raw_parts_mut(begin.as_ptr(), self.bytes as usize) }
    }

    /// Eight bytes of a mapped buffer as a number, while the device may be writing them.
    pub(crate) fn word(&self, index: usize) -> Option<u64> {
        let begin = self.allocation.as_ref()?.mapped?.cast::<u32>();
        if (index as u64 + 1) * 8 > self.bytes {
            return None;
        }
        // SAFETY: as above; it is within the buffer. Buffers may be aligned to 4 bytes only.
        let halves = [0, 1].map(|half| unsafe { begin.add(2 * index + half).read_volatile() });
        Some(bytemuck::cast(halves))
    }
}

/// Makes images and buffers on a host's device, and frees them.
pub struct Memory {
    allocator: Option<Box<dyn Allocator>>,
    host: Host,
}

impl Memory {
    pub(crate) fn new(host: &Host, allocator: Box<dyn Allocator>) -> Self {
        Self { allocator: Some(allocator), host: host.clone() }
    }

    fn take(
        &mut self,
        name: &str,
        requirements: vk::MemoryRequirements,
        used_by: MemoryUse,
        is_linear: bool,
    ) -> Result<Allocation> {
        let allocator = self.allocator.as_mut().expect("alive until destroy");
        let got = allocator.allocate(&MemoryRequest { name, requirements, used_by, is_linear })?;
        let wrong = if got.memory == vk::DeviceMemory::null() {
            "no memory"
        } else if !got.offset.is_multiple_of(requirements.alignment.max(1)) {
            "an offset that is not aligned"
        } else if used_by != MemoryUse::Device && got.mapped.is_none() {
            "memory that is not mapped"
        } else {
            return Ok(got);
        };
        allocator.free(got);
        Err(Error::Device {
            doing: format!("allocating {} bytes for {name}", requirements.size),
            reason: format!("the allocator gave {wrong}"),
        })
    }

    /// Bytes taken from the device.
    pub(crate) fn bytes(&self) -> u64 {
        self.allocator.as_ref().map_or(0, |a| a.bytes())
    }

    /// An image or buffer of a plan; buffers in memory of that kind, images in device memory.
    pub(crate) fn make(&mut self, name: &str, kind: Kind, used_by: MemoryUse) -> Result<Backed> {
        match kind {
            Kind::Image { format, width, height, layers, layered } => {
                self.image(name, format, [width, height, layers], layered)
            }
            Kind::Buffer { bytes, texels } => {
                let usage = if texels {
                    vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER
                        | vk::BufferUsageFlags::STORAGE_BUFFER
                } else {
                    vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::INDIRECT_BUFFER
                };
                let usage = usage | vk::BufferUsageFlags::TRANSFER_SRC;
                let mut backed = self.buffer(name, bytes.max(16), usage, used_by)?;
                if texels {
                    let info = vk::BufferViewCreateInfo::default()
                        .buffer(backed.buffer)
                        .format(vk::Format::R32G32B32A32_SFLOAT)
                        .range(vk::WHOLE_SIZE);
                    // SAFETY: the buffer was made above for this use.
                    let made = unsafe { self.host.device.create_buffer_view(&info, None) };
                    let made = made.map_err(failed(format!("viewing buffer {name}"))).map(|view| {
                        self.host.name(view, name);
                        backed.texels = view;
                    });
                    return self.kept(backed, made);
                }
                Ok(backed)
            }
        }
    }

    /// An image of a plan.
    pub(crate) fn image(
        &mut self,
        name: &str,
        format: Format,
        extent: [u32; 3],
        layered: bool,
    ) -> Result<Backed> {
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let one = vk::SampleCountFlags::TYPE_1;
        self.image_for(name, (format.vk(), usage, one), extent, layered)
    }

    /// An image of any format, for one use, its memory and a view of it.
    pub(crate) fn image_for(
        &mut self,
        name: &str,
        (format, usage, samples): (vk::Format, vk::ImageUsageFlags, vk::SampleCountFlags),
        [width, height, layers]: [u32; 3],
        layered: bool,
    ) -> Result<Backed> {
        // A plan may be for another device.
        // SAFETY: the physical device is the instance's, which is alive.
        let device =
            unsafe { self.host.instance.get_physical_device_properties(self.host.physical_device) };
        let most = [device.limits.max_image_dimension2_d, device.limits.max_image_array_layers];
        if width.max(height) > most[0] || layers > most[1] {
            return Err(Error::Limit {
                what: format!("image {name}"),
                needs: format!("{width} × {height} texels in {layers} layers"),
                limit: format!("{0} × {0} texels in {1} layers, of this device", most[0], most[1]),
            });
        }
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(layers)
            .samples(samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        let view_type =
            if layered { vk::ImageViewType::TYPE_2D_ARRAY } else { vk::ImageViewType::TYPE_2D };
        let range = vk::ImageSubresourceRange { layer_count: layers, ..whole_attachment(format) };
        let device = self.host.device.clone();
        // SAFETY: the device is alive, as the callers of Renderer::new and Headless guarantee; `info` is a
        // plain 2D image within the device's limits.
        let image = unsafe { device.create_image(&info, None) }
            .map_err(failed(format!("making image {name}")))?;
        let mut backed = Backed { image, layers, ..Backed::default() };
        // SAFETY: `image` was made above on this device.
        let requirements = unsafe { device.get_image_memory_requirements(image) };
        let made = self.take(name, requirements, MemoryUse::Device, false).and_then(|allocation| {
            let view_info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(view_type)
                .format(format)
                .subresource_range(range);
            // SAFETY: the allocation is at least as large as the image requires and bound once; the view has
            // the image's own format and layers.
            let view = unsafe {
                device
                    .bind_image_memory(image, allocation.memory, allocation.offset)
                    .and_then(|()| device.create_image_view(&view_info, None))
            };
            backed.allocation = Some(allocation);
            backed.view = view.map_err(failed(format!("making image {name}")))?;
            self.host.name(image, name);
            self.host.name(backed.view, name);
            Ok(())
        });
        self.kept(backed, made)
    }

    pub fn buffer(
        &mut self,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        used_by: MemoryUse,
    ) -> Result<Backed> {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        let device = self.host.device.clone();
        // SAFETY: the device is alive; the size is not 0.
        let buffer = unsafe { device.create_buffer(&info, None) }
            .map_err(failed(format!("making buffer {name}")))?;
        let mut backed = Backed { buffer, bytes, ..Backed::default() };
        // SAFETY: `buffer` was made above on this device.
        let requirements = unsafe { device.get_buffer_memory_requirements(buffer) };
        let made = self.take(name, requirements, used_by, true).and_then(|allocation| {
            // SAFETY: the allocation is at least as large as the buffer requires and bound once.
            let bound =
                unsafe { device.bind_buffer_memory(buffer, allocation.memory, allocation.offset) };
            backed.allocation = Some(allocation);
            self.host.name(buffer, name);
            bound.map_err(failed(format!("binding buffer {name}")))
        });
        self.kept(backed, made)
    }

    /// What was made, or the error of its making, after which it is freed.
    fn kept(&mut self, mut backed: Backed, made: Result<()>) -> Result<Backed> {
        match made {
            Ok(()) => Ok(backed),
            Err(error) => {
                self.free(&mut backed);
                Err(error)
            }
        }
    }

    /// Drops the allocator; everything must have been freed.
    pub(crate) fn end(&mut self) {
        self.allocator = None;
    }

    /// If [`end`](Self::end) was not called, prints the owner and keeps all memory until the device is destroyed, because images and
    /// buffers may still be in use.
    pub(crate) fn leak(&mut self, owner: &str) {
        if let Some(allocator) = self.allocator.take() {
            eprintln!("ridgelight: {owner} was dropped without destroy(): its Vulkan objects stay");
            std::mem::forget(allocator);
        }
    }

    /// Frees what `make`, `image` or `buffer` returned. The device must be done with it.
    pub fn free(&mut self, backed: &mut Backed) {
        let device = &self.host.device;
        // SAFETY: the handles came from this device and are null or alive; the caller guarantees that no
        // command in flight uses them.
        unsafe {
            device.destroy_image_view(backed.view, None);
            device.destroy_image(backed.image, None);
            device.destroy_buffer_view(backed.texels, None);
            device.destroy_buffer(backed.buffer, None);
        }
        let allocation = std::mem::take(backed).allocation;
        if let (Some(allocation), Some(allocator)) = (allocation, self.allocator.as_mut()) {
            allocator.free(allocation);
        }
    }
}

/// The whole of a colour image.
pub fn whole(layers: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: layers,
    }
}

/// A copy between a buffer, its rows consecutive, and all of a colour image of these columns, rows and layers.
pub fn region([width, height, layer_count]: [u32; 3]) -> vk::BufferImageCopy {
    let aspect_mask = vk::ImageAspectFlags::COLOR;
    vk::BufferImageCopy::default()
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask,
            mip_level: 0,
            base_array_layer: 0,
            layer_count,
        })
        .image_extent(vk::Extent3D { width, height, depth: 1 })
}
