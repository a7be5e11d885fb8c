# %% [markdown]
# # Identification
#
# The other way round: from the energy loss and the phase lag that a contact was measured to have, to the material. The measurement
# here is computed, of a solid that is known, with one per cent of noise.

# %%
import matplotlib.pyplot as plt
import numpy as np

import contact_dma as cd

solid = cd.Material.relaxation("20 MPa", [("150 MPa", "10 ms"), ("60 MPa", "1 s")], poisson_ratio=0.45)
sphere, drive = cd.Sphere("2 mm"), dict(mean="0.2 N", amplitude="0.1 N")
w = np.logspace(-1.5, 3, 14)  # rad/s
cycles = cd.sweep(solid, sphere, angular_frequency=w, springs=64, steps=64, error_bars=False, **drive)

noise = np.random.default_rng(1)
data = {"angular_frequency_rad_per_s": w}
for column, error in [("energy_loss_j", "energy_loss_error_j"), ("phase_lag_rad", "phase_lag_error_rad"), ("approach_max_m", "approach_max_error_m")]:
    data[column] = cycles[column] * (1 + 0.01 * noise.standard_normal(len(w)))
    data[error] = 0.01 * data[column]

# %%
found = cd.identify(data, sphere, poisson_ratio=0.45, **drive)
print(*found.report, sep="\n")

# %%
figure, axes = plt.subplots(figsize=(5, 3.6), constrained_layout=True)
fine = np.logspace(-1.5, 3, 200)
for part, name, color in [(np.real, "E′", "tab:blue"), (np.imag, "E″", "tab:red")]:
    axes.plot(fine, part(found.material.complex_modulus(fine)) / 1e6, color=color, label=f"{name} identified")
    axes.plot(fine, part(solid.complex_modulus(fine)) / 1e6, "k:", label=f"{name} true")
axes.set(xscale="log", yscale="log", xlabel="angular frequency ω (rad/s)", ylabel="modulus (MPa)")
axes.legend()
figure.savefig("identification.png", dpi=150)
