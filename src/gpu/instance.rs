use std::ffi::c_char;

use ash::{ext, vk};

use super::requirements::{report, requirements};
use super::surface::Surface;
use super::{DeviceReport, failed, validation};
use crate::{Error, Result};

pub(super) fn load() -> Result<ash::Entry> {
    // SAFETY: loading the system's Vulkan loader runs its initialisers, which is its purpose.
    unsafe { ash::Entry::load() }.map_err(|e| Error::Device {
        doing: "loading Vulkan".into(),
        reason: format!(
            "{e}; install a Vulkan loader and a driver (Debian: libvulkan1 mesa-vulkan-drivers)"
        ),
    })
}

fn no_driver() -> Error {
    Error::Device {
        doing: "choosing a device".into(),
        reason: "no Vulkan driver was found (Debian: install mesa-vulkan-drivers)".into(),
    }
}

/// An instance; with the validation layer where there is a `messenger` for its messages.
pub(super) fn instance(
    entry: &ash::Entry,
    api_version: u32,
    messenger: Option<&mut vk::DebugUtilsMessengerCreateInfoEXT<'_>>,
    extensions: &[*const c_char],
) -> Result<ash::Instance> {
    let app =
        vk::ApplicationInfo::default().application_name(c"ridgelight").api_version(api_version);
    let settings = validation::settings();
    let mut layer_settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
    let layers = [validation::LAYER.as_ptr()];
    let mut extensions = extensions.to_vec();
    if messenger.is_some() {
        extensions.push(ext::debug_utils::NAME.as_ptr());
    }
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&app)
        .enabled_extension_names(&extensions);
    if let Some(messenger) = messenger {
        info =
            info.enabled_layer_names(&layers).push_next(&mut layer_settings).push_next(messenger);
    }
    // SAFETY: names are nul-terminated and live across the call; so do the chained structs.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => no_driver(),
        other => failed("making a Vulkan instance")(other),
    })
}

/// All devices of the system.
///
/// # Errors
/// No loader, or no working driver.
pub fn devices() -> Result<Vec<DeviceReport>> {
    let entry = load()?;
    let instance = instance(&entry, requirements().api_version, None, &[])?;
    // SAFETY: the instance is alive; it is destroyed after its last use.
    unsafe {
        let found = instance.enumerate_physical_devices().map_err(failed("listing devices"));
        let reports = found.map(|all| all.into_iter().map(|d| report(&instance, d)).collect());
        instance.destroy_instance(None);
        reports
    }
}

/// The device of an instance that [`choose`] selects.
pub(super) fn chosen(
    instance: &ash::Instance,
    wanted: Option<&str>,
    surface: Option<&Surface>,
) -> Result<(vk::PhysicalDevice, DeviceReport)> {
    // SAFETY: the instance is alive.
    let all =
        unsafe { instance.enumerate_physical_devices() }.map_err(failed("listing devices"))?;
    let mut reports: Vec<_> = all.iter().map(|d| report(instance, *d)).collect();
    for (report, device) in reports.iter_mut().zip(&all) {
        report.missing.extend(surface.and_then(|s| s.missing(instance, *device)));
    }
    let index = choose(&reports, wanted)?;
    Ok((all[index], reports.swap_remove(index)))
}

/// Selects one of the `reports` of [`devices`]: the one `wanted`, by number or by part of its name. None: the
/// first suitable GPU, else the first suitable device.
///
/// # Errors
/// No such device, no device at all, or one that lacks a requirement (named).
pub fn choose(reports: &[DeviceReport], wanted: Option<&str>) -> Result<usize> {
    let listed = || reports.iter().map(|r| r.name.as_str()).collect::<Vec<_>>().join(", ");
    let no = |reason: String| Error::Device { doing: "choosing a device".into(), reason };
    let index = match wanted {
        Some(wanted) => {
            let lower = wanted.to_lowercase();
            let named = || reports.iter().position(|r| r.name.to_lowercase().contains(&lower));
            // A number is not searched for in names, which contain version numbers.
            let found = match wanted.parse::<usize>() {
                Ok(number) => Some(number).filter(|i| *i < reports.len()),
                Err(_) if wanted.is_empty() => None,
                Err(_) => named(),
            };
            found.ok_or_else(|| {
                no(format!("there is no device {wanted:?}; there are, from 0: {}", listed()))
            })?
        }
        None => {
            let fit = |r: &DeviceReport| r.missing.is_empty();
            let gpu = reports.iter().position(|r| fit(r) && !r.limits.is_cpu);
            let any = || reports.iter().position(fit);
            gpu.or_else(any).or((!reports.is_empty()).then_some(0)).ok_or_else(no_driver)?
        }
    };
    let report = &reports[index];
    if !report.missing.is_empty() {
        return Err(no(format!("{} lacks {}", report.name, report.missing.join(", "))));
    }
    Ok(index)
}
