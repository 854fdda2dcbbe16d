def psd_2d_of_map(): pass
