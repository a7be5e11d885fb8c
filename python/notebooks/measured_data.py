# %% [markdown]
# # From measured moduli to a curve of the loss
#
# Storage and loss modulus from a DMA at several temperatures are shifted to a master curve and fitted by a Prony series; the sweep
# then says what a contact of this material dissipates at two temperatures.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import contact_dma as cd

data = next(folder / "sweeps/pyvisco-freq-user-raw.csv" for folder in Path(globals().get("__file__", "notebook")).resolve().parents if (folder / "sweeps").is_dir())
temperatures = ["25 °C", "60 °C"]
materials = [cd.Material.from_dynamic(data, poisson_ratio=0.38, temperature_of_sweep=t) for t in temperatures]

# %%
w = np.logspace(-3, 3, 25)  # rad/s
options = dict(mean="1 N", amplitude="0.5 N", angular_frequency=w, springs=128, steps=64)
results = [cd.sweep(material, cd.Sphere("5 mm"), **options) for material in materials]

figure, (moduli, losses) = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
fine = np.logspace(-3, 3, 200)
for color, temperature, material, result in zip(["tab:blue", "tab:red"], temperatures, materials, results):
    e = material.complex_modulus(fine)
    moduli.plot(fine, e.real / 1e6, color=color, label=f"E′, {temperature}")
    moduli.plot(fine, e.imag / 1e6, "--", color=color, label=f"E″, {temperature}")
    losses.plot(result["angular_frequency_rad_per_s"], result["energy_loss_j"] * 1e6, "o-", ms=3, color=color, label=temperature)
moduli.set(xscale="log", yscale="log", xlabel="angular frequency ω (rad/s)", ylabel="modulus (MPa)")
moduli.set_ylim(20)
moduli.legend(ncols=2, loc="lower right")
losses.set(xscale="log", xlabel="angular frequency ω (rad/s)", ylabel="energy loss ΔW (µJ)")
losses.legend(title="temperature")
figure.savefig("measured-data.png", dpi=150)
