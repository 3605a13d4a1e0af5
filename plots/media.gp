# Refractive indices of four media relative to vacuum, L the wavelength in nm, and the angles that follow from an
# index, in degrees.
# Taken from the sources, independently of the program's catalogue, so that the lines test the points.
# Ciddor, Appl. Opt. 35, 1566 (1996); glass catalogues give indices relative to air.
n_air(L) = 1 + 0.05792105/(238.0185 - 1e6/L**2) + 0.00167917/(57.362 - 1e6/L**2)
sellmeier(L, B1, C1, B2, C2, B3, C3) = sqrt(1 + (B1/(L**2 - C1) + B2/(L**2 - C2) + B3/(L**2 - C3))*L**2)
# Schott, optical glass catalogue (2017), L in um.
n_sf11(L) = n_air(L)*sellmeier(L/1e3, 1.73848403, 0.0136068604, 0.311168974, 0.0615960463, 1.17490871, 121.922711)
n_bk7(L) = n_air(L)*sellmeier(L/1e3, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653)
# Malitson, J. Opt. Soc. Am. 55, 1205 (1965).
n_silica(L) = n_air(L)*sellmeier(L/1e3, 0.6961663, 0.0684043**2, 0.4079426, 0.1162414**2, 0.8974794, 9.896161**2)
# Daimon and Masumura, Appl. Opt. 46, 3811 (2007), 20 C.
n_water(L) = sqrt(sellmeier(L/1e3, 0.5684027565, 0.005101829712, 0.1726177391, 0.01821153936, 0.02086189578, 0.02620722293)**2 \
    + 0.1130748688*(L/1e3)**2/((L/1e3)**2 - 10.69792721))
# Rheims, Koeser and Wriedt, Meas. Sci. Technol. 8, 601 (1997), measured from 476.5 nm on.
n_ethanol(L) = n_air(L)*(1.35265 + 0.00306/(L/1e3)**2 + 0.00002/(L/1e3)**4)
# Minimum deviation of a prism of 60 degrees: Hecht, Optics, 5.5.1.
least_deviation(n) = (2*asin(n/2) - pi/3)*180/pi
# The primary rainbow, Descartes, Les Meteores (1637): 4 t - 2 i where cos^2 i = (n^2 - 1)/3, sin i = n sin t.
rainbow(n) = (4*asin(sqrt((4 - n**2)/3)/n) - 2*asin(sqrt((4 - n**2)/3)))*180/pi
