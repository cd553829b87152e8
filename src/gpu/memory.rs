mod attachment;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{
    Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc,
};

use super::{Host, failed};
use crate::plan::{Format, Kind};
use crate::{Error, Result};

pub(crate) use attachment::{DEPTH, whole_attachment};

/// Memory is taken from the device in blocks of this size, and what is larger alone: the least that the
/// allocator offers, so that what is held is near what a plan says.
const BLOCK_BYTES: u64 = 4 << 20;

/// An image or a buffer with its memory.
pub(crate) struct Backed {
    pub image: vk::Image,
    pub view: vk::ImageView,
    pub buffer: vk::Buffer,
    pub texels: vk::BufferView,
    pub allocation: Option<Allocation>,
    pub layers: u32,
}

/// Makes images and buffers on a host's device and frees them again.
pub(crate) struct Memory {
    allocator: Option<Allocator>,
    host: Host,
}

impl Memory {
    pub fn new(host: &Host) -> Result<Self> {
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: host.instance.clone(),
            device: host.device.clone(),
            physical_device: host.physical_device,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: gpu_allocator::AllocationSizes::new(BLOCK_BYTES, BLOCK_BYTES),
        })
        .map_err(|e| Error::Device {
            doing: "starting the allocator".into(),
            reason: e.to_string(),
        })?;
        Ok(Self { allocator: Some(allocator), host: host.clone() })
    }

    fn take(
        &mut self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Allocation> {
        let allocator = self.allocator.as_mut().expect("alive until destroy");
        allocator
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|e| Error::Device {
                doing: format!("allocating {} bytes for {name}", requirements.size),
                reason: e.to_string(),
            })
    }

    /// Bytes taken from the device.
    pub fn bytes(&self) -> u64 {
        self.allocator.as_ref().map_or(0, Allocator::capacity)
    }

    /// An image or buffer of a plan; buffers in memory of that kind, images in the device's.
    pub fn make(&mut self, name: &str, kind: Kind, location: MemoryLocation) -> Result<Backed> {
        match kind {
            Kind::Image { format, width, height, layers, layered } => {
                self.image(name, format, [width, height, layers], layered)
            }
            Kind::Buffer { bytes, texels } => {
                let usage = if texels {
                    vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER
                } else {
                    vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::INDIRECT_BUFFER
                };
                let usage = usage | vk::BufferUsageFlags::TRANSFER_SRC;
                let mut backed = self.buffer(name, bytes.max(16), usage, location)?;
                if texels {
                    let info = vk::BufferViewCreateInfo::default()
                        .buffer(backed.buffer)
                        .format(vk::Format::R32G32B32A32_SFLOAT)
                        .range(vk::WHOLE_SIZE);
                    // SAFETY: the buffer was made above for this use.
                    let view = unsafe { self.host.device.create_buffer_view(&info, None) };
                    match view {
                        Ok(view) => backed.texels = view,
                        Err(result) => {
                            self.free(&mut backed);
                            return Err(failed(format!("viewing buffer {name}"))(result));
                        }
                    }
                }
                Ok(backed)
            }
        }
    }

    pub fn image(
        &mut self,
        name: &str,
        format: Format,
        [width, height, layers]: [u32; 3],
        layered: bool,
    ) -> Result<Backed> {
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format.vk())
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        let device = self.host.device.clone();
        // SAFETY: the device is alive (the caller of Renderer::new and Headless vouch for it), `info`
        // is a plain 2D image within the plan's limits.
        let image = unsafe { device.create_image(&info, None) }
            .map_err(failed(format!("making image {name}")))?;
        let mut backed = Backed {
            image,
            view: vk::ImageView::null(),
            buffer: vk::Buffer::null(),
            texels: vk::BufferView::null(),
            allocation: None,
            layers,
        };
        // SAFETY: `image` was made above on this device.
        let requirements = unsafe { device.get_image_memory_requirements(image) };
        let made =
            self.take(name, requirements, MemoryLocation::GpuOnly, false).and_then(|allocation| {
                let view_info = vk::ImageViewCreateInfo::default()
                    .image(image)
                    .view_type(if layered {
                        vk::ImageViewType::TYPE_2D_ARRAY
                    } else {
                        vk::ImageViewType::TYPE_2D
                    })
                    .format(format.vk())
                    .subresource_range(whole(layers));
                // SAFETY: the allocation is at least as large as the image requires and bound once; the
                // view is of the image's own format and layers.
                let view = unsafe {
                    device
                        .bind_image_memory(image, allocation.memory(), allocation.offset())
                        .and_then(|()| device.create_image_view(&view_info, None))
                };
                backed.allocation = Some(allocation);
                backed.view = view.map_err(failed(format!("making image {name}")))?;
                Ok(())
            });
        match made {
            Ok(()) => {
                self.label(image, name);
                Ok(backed)
            }
            Err(error) => {
                self.free(&mut backed);
                Err(error)
            }
        }
    }

    pub fn buffer(
        &mut self,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Backed> {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        let device = self.host.device.clone();
        // SAFETY: the device is alive; the size is not 0.
        let buffer = unsafe { device.create_buffer(&info, None) }
            .map_err(failed(format!("making buffer {name}")))?;
        let mut backed = Backed {
            image: vk::Image::null(),
            view: vk::ImageView::null(),
            buffer,
            texels: vk::BufferView::null(),
            allocation: None,
            layers: 0,
        };
        // SAFETY: `buffer` was made above on this device.
        let requirements = unsafe { device.get_buffer_memory_requirements(buffer) };
        let made = self.take(name, requirements, location, true).and_then(|allocation| {
            // SAFETY: the allocation is at least as large as the buffer requires and bound once.
            let bound = unsafe {
                device.bind_buffer_memory(buffer, allocation.memory(), allocation.offset())
            };
            backed.allocation = Some(allocation);
            bound.map_err(failed(format!("binding buffer {name}")))
        });
        match made {
            Ok(()) => {
                self.label(buffer, name);
                Ok(backed)
            }
            Err(error) => {
                self.free(&mut backed);
                Err(error)
            }
        }
    }

    fn label(&self, handle: impl vk::Handle, name: &str) {
        let (Some(debug), Ok(name)) = (&self.host.debug_utils, std::ffi::CString::new(name)) else {
            return;
        };
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // A name that could not be set is no reason to fail.
        // SAFETY: the handle was made on this device and is alive.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// Gives all memory blocks back to the device; everything must have been freed.
    pub fn end(&mut self) {
        self.allocator = None;
    }

    /// Keeps all memory until the device goes: for images and buffers that may still be in use.
    pub fn leak(&mut self) {
        std::mem::forget(self.allocator.take());
    }

    /// Frees what `make`, `image` or `buffer` returned. The device must be done with it.
    pub fn free(&mut self, backed: &mut Backed) {
        let device = &self.host.device;
        // SAFETY: the handles came from this device and are null or alive; whoever calls says that no
        // command in flight uses them.
        unsafe {
            device.destroy_image_view(backed.view, None);
            device.destroy_image(backed.image, None);
            device.destroy_buffer_view(backed.texels, None);
            device.destroy_buffer(backed.buffer, None);
        }
        (backed.view, backed.image) = Default::default();
        (backed.texels, backed.buffer) = Default::default();
        if let (Some(allocation), Some(allocator)) =
            (backed.allocation.take(), self.allocator.as_mut())
        {
            // Freeing an allocation of this allocator cannot fail; if it did, memory is lost until
            // the device goes.
            let _ = allocator.free(allocation);
        }
    }
}

/// All of a colour image.
pub(crate) fn whole(layers: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: layers,
    }
}
