use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};

use ash::{ext, vk};

use super::failed;
use crate::{Error, Result};

pub(super) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The layer's messages, oldest first.
pub(super) type Messages = Arc<Mutex<Vec<String>>>;

/// An error where the layer is not installed.
pub(super) fn require(entry: &ash::Entry) -> Result<()> {
    // SAFETY: a query without preconditions.
    let known =
        unsafe { entry.enumerate_instance_layer_properties() }.map_err(failed("listing layers"))?;
    if known.iter().any(|l| l.layer_name_as_c_str() == Ok(LAYER)) {
        return Ok(());
    }
    Err(Error::Device {
        doing: "turning validation on".into(),
        reason: "no VK_LAYER_KHRONOS_validation is installed".into(),
    })
}

/// Enables one of the layer's settings.
fn setting(key: &'static CStr) -> vk::LayerSettingEXT<'static> {
    const ON: [u8; 4] = vk::TRUE.to_ne_bytes();
    let mut setting = vk::LayerSettingEXT::default()
        .layer_name(LAYER)
        .setting_name(key)
        .ty(vk::LayerSettingTypeEXT::BOOL32)
        .values(&ON);
    // One VkBool32; ash 0.38 counts bytes.
    setting.value_count = 1;
    setting
}

/// Synchronisation validation. The second setting is needed to find hazards of dispatches on one buffer.
pub(super) fn settings() -> [vk::LayerSettingEXT<'static>; 2] {
    [setting(c"validate_sync"), setting(c"syncval_shader_accesses_heuristic")]
}

/// A messenger that keeps warnings and errors in `messages`, which must outlive it.
pub(super) fn messenger(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(
            vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
        )
        .message_type(
            vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
        )
        .pfn_user_callback(Some(keep_message))
        .user_data(Arc::as_ptr(messages).cast_mut().cast())
}

/// An instance's messenger and its messages; only [`Listener::end`] destroys it.
pub(super) struct Listener {
    loader: ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    messages: Messages,
}

impl Listener {
    pub(crate) fn new(
        entry: &ash::Entry,
        instance: &ash::Instance,
        messages: Messages,
    ) -> Result<Self> {
        let loader = ext::debug_utils::Instance::new(entry, instance);
        let info = messenger(&messages);
        // SAFETY: the callback's data lives as long as this.
        let messenger = unsafe { loader.create_debug_utils_messenger(&info, None) }
            .map_err(failed("listening to validation"))?;
        Ok(Self { loader, messenger, messages })
    }

    /// Messages since the last call.
    pub(crate) fn take(&self) -> Vec<String> {
        self.messages.lock().map(|mut m| std::mem::take(&mut *m)).unwrap_or_default()
    }

    /// Destroys the messenger: once, before the instance. The messenger of instance creation reports until the
    /// instance is destroyed, so this must be dropped after it.
    pub(crate) fn end(&self) {
        // SAFETY: the instance is alive; the messenger is its own, and not used again.
        unsafe { self.loader.destroy_debug_utils_messenger(self.messenger, None) };
    }
}

unsafe extern "system" fn keep_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes valid callback data; `user` is the Mutex of a `Messages` that outlives the
    // messenger.
    unsafe {
        let kept = &*user.cast::<Mutex<Vec<String>>>();
        let text = (*data)
            .message_as_c_str()
            .map_or_else(String::new, |m| m.to_string_lossy().into_owned());
        if let Ok(mut kept) = kept.lock() {
            kept.push(text);
        }
    }
    vk::FALSE
}
