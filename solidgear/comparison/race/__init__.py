"""Error against cost: discretisations of one scene, timed in turns."""
