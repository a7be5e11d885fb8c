# %% [markdown]
# # A first sweep
#
# A steel sphere on PMMA, loaded by 10 N that oscillate by 5 N: at which frequency is the most energy lost in a cycle?

# %%
import matplotlib.pyplot as plt
import numpy as np

import contact_dma as cd

pmma = cd.Material.library("pmma")
w = np.logspace(-4, 0, 25)  # rad/s
result = cd.sweep(pmma, cd.Sphere("10 mm"), mean="10 N", amplitude="5 N", angular_frequency=w)
result

# %% [markdown]
# The columns are arrays in SI units, with their errors beside them; the peak is located between the samples.

# %%
peak = result.peaks[0]
print(f"most at {peak.angular_frequency:.4g} rad/s: {peak.energy_loss:.4g} J, to within {peak.energy_loss_error:.1g} J")

figure, (curve, loops) = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
curve.errorbar(result["angular_frequency_rad_per_s"], result["energy_loss_j"] * 1e6, result["energy_loss_error_j"] * 1e6, fmt="o-", ms=3)
curve.plot(peak.angular_frequency, peak.energy_loss * 1e6, "*", ms=11, color="tab:red")
curve.set(xscale="log", xlabel="angular frequency ω (rad/s)", ylabel="energy loss ΔW (µJ)")
for k in (0, int(np.argmax(result["energy_loss_j"])), len(w) - 1):
    cycle = result.cycles[k]
    loops.plot(cycle.approach * 1e6, cycle.load, label=f"{cycle.angular_frequency:.2g} rad/s")
loops.set(xlabel="approach δ (µm)", ylabel="load W (N)")
loops.legend(title="ω")
figure.savefig("first-sweep.png", dpi=150)
